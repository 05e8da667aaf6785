#pragma once
#include "scene/job_context.h"
#include "scene/result.h"
#include "scene/scene.h"

#include <filesystem>
#include <string>

struct aiScene;

namespace lodestone {

struct SourceFile {
    std::filesystem::path path;
    std::string extension;   // lower case, with dot
    std::uint64_t bytes = 0; // of the files read so far
};

// Makes a Scene of assimp's: node tree, submeshes (one for every set of meshes that nodes draw,
// equal ones folded), materials, images, cameras, notes. Errors: BadInput, Cancelled.
Result<ScenePtr> convertScene(const aiScene& scene, const SourceFile& file, const JobContext& job);

} // namespace lodestone
