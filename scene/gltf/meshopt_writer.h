#pragma once
#include "scene/gltf/packed_document.h"

namespace lodestone {

// Packs geometry and instance rows by EXT_meshopt_compression: one view for each mode, filter and
// stride. The uncompressed views lie in a placeholder buffer marked as fallback, without bytes.
// Integers (positions on a grid, colours, joints) and floats of skinned or morphed positions keep
// their bits. Directions are octahedral with 8 bits; texture coordinates lie on a grid of 2^-13.
// Rows: translations lie on a grid, rotations have 6 to 16 bits, scales lie on a grid, each as fine
// as moves no point by more than 2^-15 of the scene's diagonal.
// Same input, same bytes. O(bytes).
void packMeshopt(PackedDocument& document);

} // namespace lodestone
