#include "scene/gltf/container.h"

#include <cstring>
#include <fstream>
#include <optional>
#include <span>
#include <string_view>

namespace lodestone {

namespace {

constexpr std::uint32_t kMagic = 0x46546C67u;     // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534Au; // "JSON"
constexpr std::uint32_t kBinChunk = 0x004E4942u;  // "BIN"
constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr int kMaxNesting = 256;

std::uint32_t readU32(std::span<const std::byte> bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
}

// Copying and writing a JSON value recurses by its nesting, so nesting is bounded before.
bool nestsTooDeep(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                in_string = false;
        } else if (c == '"') {
            in_string = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kMaxNesting)
                return true;
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
    return false;
}

std::string oneLine(std::string text) {
    for (char& c : text)
        if (static_cast<unsigned char>(c) < 0x20)
            c = ' ';
    return text.substr(0, 160);
}

Result<nlohmann::json> parseJson(std::string_view text, const std::string& file) {
    while (!text.empty() && text.back() == '\0') // some writers pad the chunk with zeros
        text.remove_suffix(1);
    if (text.find_first_not_of(" \t\r\n") == std::string_view::npos ||
        text[text.find_first_not_of(" \t\r\n")] != '{')
        return badInput(file + ": content is neither JSON nor GLB, so this is not a glTF file: "
                               "check its type");
    if (nestsTooDeep(text))
        return badInput(file + ": JSON is nested deeper than " + std::to_string(kMaxNesting) +
                        " levels: re-export the file");
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::exception& e) {
        return badInput(file + ": JSON does not parse (" + oneLine(e.what()) +
                        "): the file is damaged or not glTF");
    }
}

std::string_view asText(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

Result<GltfContainer> readGlb(std::span<const std::byte> bytes, const std::string& file) {
    if (bytes.size() < kHeaderBytes)
        return badInput(file + ": GLB ends within its header: copy the file again");
    const std::uint32_t version = readU32(bytes, 4);
    if (version != 2)
        return badInput(file + ": GLB version " + std::to_string(version) +
                        " is not supported: convert it to glTF 2.0");
    const std::uint32_t length = readU32(bytes, 8);
    if (length > bytes.size())
        return badInput(file + ": GLB is truncated, its header says " + std::to_string(length) +
                        " bytes but there are " + std::to_string(bytes.size()) +
                        ": copy the file again");
    bytes = bytes.first(length);
    std::optional<nlohmann::json> json;
    GltfContainer container;
    for (std::size_t at = kHeaderBytes; at + kChunkHeaderBytes <= bytes.size();) {
        const std::uint32_t size = readU32(bytes, at);
        const std::uint32_t type = readU32(bytes, at + 4);
        at += kChunkHeaderBytes;
        if (size > bytes.size() - at)
            return badInput(file + ": GLB chunk at byte " + std::to_string(at) + " says " +
                            std::to_string(size) + " bytes but " +
                            std::to_string(bytes.size() - at) + " are left: copy the file again");
        const std::span<const std::byte> chunk = bytes.subspan(at, size);
        if (type == kJsonChunk && !json) {
            Result<nlohmann::json> parsed = parseJson(asText(chunk), file);
            if (!parsed)
                return tl::make_unexpected(parsed.error());
            json = std::move(*parsed);
        } else if (type == kBinChunk && json && !container.has_binary) {
            container.binary.assign(chunk.begin(), chunk.end());
            container.has_binary = true;
        }
        at += size;
    }
    if (!json)
        return badInput(file + ": GLB has no JSON chunk: re-export the file");
    container.json = std::move(*json);
    return container;
}

} // namespace

Result<std::vector<std::byte>> readFileBytes(const std::filesystem::path& path) {
    const std::string file = path.filename().string();
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        return badInput(file + ": no such file: check the path");
    std::ifstream stream(path, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
    if (size < 0)
        return badInput(file + ": cannot be opened: check its permissions");
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    if (stream.gcount() != size)
        return badInput(file + ": cannot be read to its end: check the disk");
    return bytes;
}

Result<GltfContainer> readContainer(const std::vector<std::byte>& bytes, const std::string& file) {
    if (bytes.empty())
        return badInput(file + ": file is empty: copy it again");
    Result<GltfContainer> container;
    if (bytes.size() >= 4 && readU32(bytes, 0) == kMagic) {
        container = readGlb(bytes, file);
    } else {
        std::string_view text = asText(bytes);
        if (text.starts_with("\xEF\xBB\xBF"))
            text.remove_prefix(3);
        Result<nlohmann::json> json = parseJson(text, file);
        if (!json)
            return tl::make_unexpected(json.error());
        container->json = std::move(*json);
    }
    if (container)
        container->file_bytes = bytes.size();
    return container;
}

} // namespace lodestone
