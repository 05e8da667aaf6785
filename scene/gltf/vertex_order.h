#pragma once
// Order of triangles and vertices that packs well and that graphics hardware likes.
#include "scene/gltf/export_plan.h"

namespace lodestone {

// The LOD with triangles in vertex-cache order and vertices in the order triangles first fetch
// them, all attributes and morph targets alike; unused vertices last. What primitives share as the
// file stores it keeps its order, so that it stays shared. shape: of the LOD.
// Deterministic; O(vertices + indices), parallel.
Lod inFetchOrder(const ExportPlan& plan, const Lod& lod, const LodShape& shape);

} // namespace lodestone
