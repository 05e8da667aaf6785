#pragma once
// What the bytes of a written GLB are spent on.
#include "scene/result.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>

namespace lodestone {

// Add up to the size of the file.
struct ByteParts {
    std::uint64_t geometry = 0;  // vertices and indices
    std::uint64_t instances = 0; // nodes and the rows of EXT_mesh_gpu_instancing
    std::uint64_t materials = 0; // materials, textures and the images in the file
    std::uint64_t json = 0;      // headers, accessors and all other JSON
    std::uint64_t other = 0;     // animations, skins, padding

    std::uint64_t total() const { return geometry + instances + materials + json + other; }
};

// Splits a GLB as exportScene writes it. name: for messages. Errors: BadInput if it is none.
Result<ByteParts> splitGlb(std::span<const std::byte> file, std::string_view name);
// Reads the file first. Errors: Failed if it cannot be read.
Result<ByteParts> splitGlbFile(const std::filesystem::path& path);

} // namespace lodestone
