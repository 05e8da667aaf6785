#pragma once
#include "simplify/collapse/sequence.h"

namespace lodestone {

// How many vertices of a submesh at a step lie on seams: places with several wedges.
struct SeamCount {
    std::uint64_t vertices = 0;
    std::uint64_t on_seams = 0;
};

// O(wedges log wedges). Any thread.
SeamCount
countOnSeams(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step);

} // namespace lodestone
