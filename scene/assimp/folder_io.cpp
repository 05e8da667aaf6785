#include "scene/assimp/folder_io.h"

#include <algorithm>
#include <cctype>

namespace lodestone {

namespace fs = std::filesystem;

namespace {

std::string lowerCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

fs::path folderOf(const fs::path& model) {
    return model.has_parent_path() ? model.parent_path() : fs::path(".");
}

// The file, links resolved, if it is a regular one inside the folder.
std::optional<fs::path> inside(const fs::path& folder, const fs::path& file) {
    std::error_code error;
    const fs::path root = fs::canonical(folder, error);
    if (error)
        return std::nullopt;
    fs::path target = fs::canonical(file, error);
    if (error || !fs::is_regular_file(target, error) || error)
        return std::nullopt;
    const auto [root_end, ignored] =
        std::mismatch(root.begin(), root.end(), target.begin(), target.end());
    if (root_end != root.end())
        return std::nullopt;
    return target;
}

// A file of the folder by name, in any case of letters; the first in order of names.
std::optional<fs::path> findByName(const fs::path& folder, const fs::path& name) {
    const std::string wanted = lowerCase(name.string());
    std::optional<fs::path> found;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
         entry.increment(error)) {
        const fs::path& candidate = entry->path();
        if (lowerCase(candidate.filename().string()) == wanted && (!found || candidate < *found))
            found = candidate;
    }
    return found;
}

} // namespace

std::optional<fs::path> findBeside(const fs::path& folder, std::string reference) {
    std::ranges::replace(reference, '\\', '/');
    const fs::path written(reference);
    if (reference.empty() || reference.find('\0') != std::string::npos)
        return std::nullopt;
    if (written.is_relative())
        if (std::optional<fs::path> found = inside(folder, folder / written))
            return found;
    if (const std::optional<fs::path> found = findByName(folder, written.filename()))
        return inside(folder, *found);
    return std::nullopt;
}

FolderIo::FolderIo(fs::path model) : model_(std::move(model)) {}

std::optional<fs::path> FolderIo::allowed(const char* file) const {
    const fs::path path(file);
    if (path == model_)
        return path;
    if (std::optional<fs::path> found = inside(folderOf(model_), path))
        return found;
    return findBeside(folderOf(model_), path.filename().string());
}

bool FolderIo::Exists(const char* file) const {
    return allowed(file).has_value();
}

Assimp::IOStream* FolderIo::Open(const char* file, const char* mode) {
    const std::optional<fs::path> path = allowed(file);
    if (!path || std::string_view(mode).find_first_not_of("rbt") != std::string_view::npos)
        return nullptr;
    std::error_code error;
    const std::uintmax_t size = fs::file_size(*path, error);
    opened_[*path] = error ? 0 : size;
    return DefaultIOSystem::Open(path->c_str(), mode);
}

std::uint64_t FolderIo::openedBytes() const {
    std::uint64_t sum = 0;
    for (const auto& [path, bytes] : opened_)
        sum += bytes;
    return sum;
}

} // namespace lodestone
