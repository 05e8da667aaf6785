#pragma once
#include "scene/gltf/packed_document.h"

namespace lodestone {

// Packs geometry and instance rows by EXT_meshopt_compression: one view for each mode, filter and
// stride. The uncompressed views lie in a placeholder buffer marked as fallback, without bytes.
// Integers (positions on a grid, colours, joints) and floats of skinned or morphed positions keep
// their bits. Directions are octahedral with 8 bits; texture coordinates lie on a grid of 2^-13.
// Rows: translations lie on a grid, rotations have 6 to 16 bits, scales lie on a grid; none of the
// three moves a point by more than 0.005 % of the scene's diagonal (a twentieth of a pixel where
// the scene is 1000 pixels across).
// Same input, same bytes. O(bytes).
void packMeshopt(PackedDocument& document);

} // namespace lodestone
