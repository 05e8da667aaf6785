#pragma once
// Inside render/ only: colours that say how far a submesh is simplified.
#include "render/gpu_scene_state.h"
#include "render/view.h"

namespace lodestone {

// Linear, opaque. By the share of the triangles that the item's submesh has kept: halving them is
// the same step everywhere, a thousandth has the last colour. Grey: as in the file.
// Cost: O(primitives of the submesh).
glm::vec4 lodStateColor(const DrawItem& item, const Scene& scene, const ViewOptions& options);

} // namespace lodestone
