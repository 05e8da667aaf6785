#pragma once
#include "scene/result.h"

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

namespace lodestone {

// A .gltf or .glb taken apart, nothing in it interpreted yet.
// The JSON library checks its invariants in noexcept moves, which clang-tidy takes for throwing.
// NOLINTNEXTLINE(bugprone-exception-escape)
struct GltfContainer {
    nlohmann::json json; // an object
    std::vector<std::byte> binary;
    bool has_binary = false; // a GLB with a BIN chunk
    std::uint64_t file_bytes = 0;
};

// Whole file as bytes. Errors: BadInput if it cannot be read.
Result<std::vector<std::byte>> readFileBytes(const std::filesystem::path& path);

// Told apart by content, not by extension. file: name for messages. JSON nested deeper than 256
// levels is refused. Errors: BadInput for a truncated or lying GLB, JSON that does not parse.
Result<GltfContainer> readContainer(const std::vector<std::byte>& bytes, const std::string& file);

} // namespace lodestone
