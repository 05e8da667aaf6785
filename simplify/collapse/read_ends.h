#pragma once
// The other ends of geomorphs (see simplify/geomorph.h).
#include "simplify/collapse/sequence.h"

namespace lodestone {

struct StepRange {
    std::uint32_t fine = 0;
    std::uint32_t coarse = 0; // >= fine
};

// Where the vertices of readOutSubmesh() at the fine step are at the coarse one, [primitives]: in
// the same order, without indices and morph targets, scaled by `scale` about `pivot`. Parallel
// where large. O(faces + wedges). Any thread.
std::vector<GeometryPtr> readOutEnds(const CollapseSequence& sequence,
                                     const Submesh& submesh,
                                     const StepRange& steps,
                                     double scale,
                                     const glm::dvec3& pivot);

} // namespace lodestone
