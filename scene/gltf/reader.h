#pragma once
#include "scene/job_context.h"
#include "scene/result.h"
#include "scene/scene.h"

#include <filesystem>

namespace lodestone {

// Reads glTF 2.0, text or binary (told apart by content).
//
// One Submesh a mesh of the document, in its order; a mesh that no node of the default scene draws
// is a submesh with no instance, so that an export keeps it. Scene::nodes has the document's order.
// KHR_draco_mesh_compression and EXT_meshopt_compression are undone; uncompressed data that stand
// beside compressed ones are preferred. Unknown extensions are kept and, if the file requires them,
// noted. Errors: BadInput, "<file>: <object>: <fault>: <remedy>"; Cancelled. Any thread.
Result<ScenePtr> readGltf(const std::filesystem::path& path, const JobContext& job);

// The same from bytes in memory. path: whose name stands in messages and beside which external
// files are looked for; it need not exist.
Result<ScenePtr> readGltfBytes(const std::vector<std::byte>& bytes,
                               const std::filesystem::path& path,
                               const JobContext& job);

} // namespace lodestone
