#include "scene/assimp/precheck.h"

#include <cctype>
#include <cstdint>
#include <cstring>
#include <string>

namespace lodestone {

namespace {

constexpr std::size_t kStlHeaderBytes = 84;
constexpr std::size_t kStlTriangleBytes = 50;

// Text has no control characters but white space.
bool isText(std::string_view bytes) {
    for (const char letter : bytes) {
        const auto value = static_cast<unsigned char>(letter);
        if (value < 0x20 && std::isspace(value) == 0)
            return false;
    }
    return true;
}

} // namespace

Result<void> checkStl(std::string_view bytes) {
    std::size_t start = 0;
    while (start < bytes.size() && std::isspace(static_cast<unsigned char>(bytes[start])) != 0)
        ++start;
    if (bytes.substr(start).starts_with("solid") && isText(bytes.substr(0, 512)))
        return {};
    if (bytes.size() < kStlHeaderBytes)
        return badInput("is too short for an STL header; export it again");
    std::uint32_t announced = 0;
    std::memcpy(&announced, bytes.data() + kStlHeaderBytes - sizeof announced, sizeof announced);
    const std::size_t held = (bytes.size() - kStlHeaderBytes) / kStlTriangleBytes;
    if (announced > held)
        return badInput("announces " + std::to_string(announced) + " triangles but holds " +
                        std::to_string(held) + "; the file is cut off, export it again");
    return {};
}

Result<void> precheck(std::string_view extension, std::string_view bytes) {
    if (bytes.empty())
        return badInput("is empty; export it again");
    if (extension == ".dae")
        return checkCollada(bytes);
    if (extension == ".ply")
        return checkPly(bytes);
    if (extension == ".stl")
        return checkStl(bytes);
    return {};
}

} // namespace lodestone
