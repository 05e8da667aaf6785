#pragma once
// Exports that are packed as a whole: Compression::Meshopt and Compression::Draco.
#include "scene/gltf/packed_document.h"
#include "scene/gltf/writer.h"

namespace lodestone {

// The packed document and its binary (a multiple of 4 bytes). buffer_file: as for exportedJson().
// Errors: as exportedJson().
Result<PackedDocument> packedExport(const ExportPlan& plan,
                                    const Layout& layout,
                                    const Lod& lod,
                                    const std::string& buffer_file);

} // namespace lodestone
