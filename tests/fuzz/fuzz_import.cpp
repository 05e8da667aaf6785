// Whatever bytes a file holds, importing it ends in a scene or an error of one line.
// Run: lodestone_fuzz_import -max_total_time=20 FOUND_DIR SEEDS_DIR
#include "scene/import.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <span>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;

// Written anew for each run; GLB by its magic, else glTF text.
fs::path writeInput(std::span<const char> bytes) {
    static const fs::path folder =
        fs::temp_directory_path() / ("lodestone_fuzz_" + std::to_string(::getpid()));
    fs::create_directories(folder);
    const bool is_binary = std::string_view(bytes.data(), bytes.size()).starts_with("glTF");
    const fs::path path = folder / (is_binary ? "input.glb" : "input.gltf");
    std::ofstream(path, std::ios::binary)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return path;
}

// What importScene promises of its error messages.
bool isOneLine(const std::string& message) {
    return !message.empty() && message.find('\n') == std::string::npos;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size_bytes) {
    const fs::path path = writeInput(std::span(reinterpret_cast<const char*>(data), size_bytes));
    const auto scene = lodestone::importScene(path, {});
    if (!scene && !isOneLine(scene.error().message))
        std::abort();
    return 0;
}
