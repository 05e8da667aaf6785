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

bool isImportable(std::string_view lower_extension) {
    return std::ranges::find(kExtensions, lower_extension) != kExtensions.end();
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

std::vector<std::filesystem::path> importableFiles(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    std::error_code error; // ends the walk
    for (std::filesystem::recursive_directory_iterator at(folder, error), end; !error && at != end;
         at.increment(error))
        if (std::error_code unknown; // no such file any more: not one of them
            isImportable(lowerExtension(at->path())) && at->is_regular_file(unknown))
            files.push_back(at->path());
    std::ranges::sort(files);
    return files;
}

Result<ScenePtr> importScene(const std::filesystem::path& path, const JobContext& job) {
    const std::string extension = lowerExtension(path);
    std::error_code error;
    if (std::filesystem::is_directory(path, error))
        return badInput(path.string() + ": is a folder: choose a file in it");
    if (extension.empty())
        return badInput(path.filename().string() + ": has no extension: name it after its type, " +
                        listExtensions());
    if (!isImportable(extension))
        return badInput(path.filename().string() + ": unknown file type '" + extension +
                        "': use one of " + listExtensions());
    if (!std::filesystem::is_regular_file(path, error))
        return badInput(path.filename().string() + ": no such file: check the path");
    if (extension == ".gltf" || extension == ".glb")
        return readGltf(path, job);
    return importWithAssimp(path, job);
}

} // namespace lodestone
