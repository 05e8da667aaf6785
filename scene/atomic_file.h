#pragma once
#include "scene/result.h"

#include <cstddef>
#include <filesystem>
#include <span>

namespace lodestone {

// A file that appears whole or not at all: written under a temporary name in the same folder, then
// synced and renamed. Without commit() nothing is left behind and an existing file is untouched.
class AtomicFile {
public:
    // Errors: Failed, naming the file and what the system says.
    static Result<AtomicFile> create(const std::filesystem::path& path);

    AtomicFile(AtomicFile&& other) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    AtomicFile(const AtomicFile&) = delete;
    AtomicFile& operator=(const AtomicFile&) = delete;
    ~AtomicFile();

    Result<void> write(std::span<const std::byte> bytes);
    // Everything written is on the disk, and nothing more can be: commit() only renames.
    Result<void> sync();
    Result<void> commit(); // after sync(), or with it

private:
    AtomicFile(std::filesystem::path path, std::filesystem::path temporary, int descriptor);
    tl::unexpected<Error> failure(const char* action) const; // by errno

    std::filesystem::path path_;
    std::filesystem::path temporary_; // empty: committed or moved from
    int descriptor_ = -1;
};

} // namespace lodestone
