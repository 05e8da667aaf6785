#pragma once
#include "scene/job_context.h"
#include "scene/result.h"
#include "scene/scene.h"

#include <filesystem>

namespace lodestone {

// Reads .gltf .glb (tinygltf) and .dae .3ds .obj .ply .stl .fbx (assimp) into a scene.
// path: any case of extension. Files it refers to must lie in its folder or below.
// Guarantees: positions finite, indices in range, every transform finite, no allocation sized by
// an unchecked number; deterministic. What could not be kept is in Scene::notes.
// Errors: BadInput, one line naming file, object, fault and remedy. Any thread.
Result<ScenePtr> importScene(const std::filesystem::path& path, const JobContext& job);

// Extensions with dot, lower case, as importScene takes them: ".gltf", ".glb", ".dae", ...
std::span<const std::string_view> importExtensions();

// Every file below a folder that importScene takes by its extension, in order; none where the
// folder is absent or cannot be read.
std::vector<std::filesystem::path> importableFiles(const std::filesystem::path& folder);

} // namespace lodestone
