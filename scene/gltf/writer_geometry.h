#pragma once
// Bytes of accessors and instance rows as an export stores them.
#include "scene/gltf/writer_json.h"

namespace lodestone {

// Failed, naming the submesh, if the LOD's geometry has other attributes than the scene's, or
// values that are not finite.
Result<void> checkLod(const ExportPlan& plan, const Lod& lod);

// As stored, after rounding; zeros where the accessor has no bounds.
AccessorBounds boundsOf(const ExportPlan& plan, const AccessorLayout& accessor, const Lod& lod);

// Padded to 4 bytes an element (not indices) and 4 in all.
std::vector<std::byte>
accessorBytes(const ExportPlan& plan, const AccessorLayout& accessor, const Lod& lod);

// Kept rows of a group in the file's order, one list for each attribute; none if none is kept.
std::vector<std::vector<std::byte>>
rowBytes(const ExportPlan& plan, const Layout& layout, const Lod& lod, std::uint32_t group);

} // namespace lodestone
