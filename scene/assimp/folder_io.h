#pragma once
// What assimp may open: the model's folder and below, for reading.
#include <assimp/DefaultIOSystem.h>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace lodestone {

// The file a model's reference means, if it exists in the model's folder or below: the path as
// written, else a file of that name beside the model (references of other machines), in any case of
// letters. Links that leave the folder are not followed.
std::optional<std::filesystem::path> findBeside(const std::filesystem::path& folder,
                                                std::string reference);

class FolderIo : public Assimp::DefaultIOSystem {
public:
    explicit FolderIo(std::filesystem::path model);

    bool Exists(const char* file) const override;
    Assimp::IOStream* Open(const char* file, const char* mode) override;

    std::uint64_t openedBytes() const; // of all files opened, each once

private:
    std::optional<std::filesystem::path> allowed(const char* file) const;

    std::filesystem::path model_;
    std::map<std::filesystem::path, std::uint64_t> opened_;
};

} // namespace lodestone
