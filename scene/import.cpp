#include "scene/import.h"

#include "scene/assimp/assimp_import.h"
#include "scene/gltf/reader.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace lodestone {

namespace {

constexpr std::array<std::string_view, 8> kExtensions{
    ".gltf", ".glb", ".dae", ".3ds", ".obj", ".ply", ".stl", ".fbx"};

std::string lowerExtension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return extension;
}

std::string listExtensions() {
    std::string list;
    for (const std::string_view extension : kExtensions)
        list += (list.empty() ? "" : " ") + std::string(extension);
    return list;
}

} // namespace

std::span<const std::string_view> importExtensions() {
    return kExtensions;
}

Result<ScenePtr> importScene(const std::filesystem::path& path, const JobContext& job) {
    const std::string extension = lowerExtension(path);
    if (std::ranges::find(kExtensions, extension) == kExtensions.end())
        return badInput(path.filename().string() + ": unknown file type '" + extension +
                        "': use one of " + listExtensions());
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return badInput(path.filename().string() + ": no such file: check the path");
    if (extension == ".gltf" || extension == ".glb")
        return readGltf(path, job);
    return importWithAssimp(path, job);
}

} // namespace lodestone
