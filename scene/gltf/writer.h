#pragma once
// Writes a LOD of a scene as glTF, and predicts what that weighs, from one plan.
#include "scene/gltf/export_plan.h"
#include "scene/gltf/writer_layout.h"

#include <functional>
#include <optional>

namespace lodestone {

// The smallest layout that the plan's options allow. O(primitives + nodes).
Layout chooseLayout(const ExportPlan& plan, const LodShape& shape);

// Bytes of all files of an export. Exact. O(primitives + written nodes).
std::uint64_t exportedBytes(const ExportPlan& plan, const Layout& layout);

// Name of the .bin beside a .gltf; short enough for the fixed width it has in the JSON.
std::string bufferFileName(const std::filesystem::path& gltf_path);

// The JSON text. buffer_file: empty for .glb.
// Errors: Failed if the LOD does not belong to the plan's scene, or a position is not finite.
Result<std::string> exportedJson(const ExportPlan& plan,
                                 const Layout& layout,
                                 const Lod& lod,
                                 const std::string& buffer_file);

// Passes on the binary buffer piece by piece, layout.binary_bytes in all. False from write stops.
// The LOD has passed exportedJson.
bool writeBinary(const ExportPlan& plan,
                 const Layout& layout,
                 const Lod& lod,
                 const std::function<bool(std::span<const std::byte>)>& write);

} // namespace lodestone
