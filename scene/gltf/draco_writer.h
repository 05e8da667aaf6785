#pragma once
#include "scene/gltf/packed_document.h"

namespace lodestone {

// Packs triangles by KHR_draco_mesh_compression, primitive by primitive, where that is smaller.
// Lines, points, morphed and carried primitives and instance rows stay as they are.
// Positions have as many bits as 2^-16 of the scene's diagonal asks for, 10 to 14 of the mesh's
// extent; normals 8 (octahedral), texture coordinates 12, colours 8; all else is lossless. Points
// may come in another order, and be fewer where several are the same. Triangles with two equal
// corners are left out and counted.
// Same input, same bytes. O(bytes).
void packDraco(PackedDocument& document);

} // namespace lodestone
