#pragma once
#include "scene/scene.h"

namespace lodestone {

// For every submesh the first one that draws the same: equal primitives in order, compared by bytes
// of positions, attributes and indices, mode and material. Names do not count.
// representative[i] <= i. O(total bytes), hashed first.
std::vector<std::uint32_t> findEqualSubmeshes(std::span<const Submesh> submeshes);

} // namespace lodestone
