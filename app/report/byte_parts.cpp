#include "app/report/byte_parts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/core.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

namespace lodestone {

namespace {

using Json = nlohmann::json;

enum class Use : std::uint8_t { Other, Geometry, Instances, Materials };

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;

std::uint32_t wordAt(std::span<const std::byte> bytes, std::size_t offset) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, sizeof word);
    return word;
}

// Calls member(key, bytes of `"key":value`) for every member of the object that the text is.
// The text is valid JSON.
template <class Member>
void forEachTopMember(std::string_view text, Member member) {
    std::size_t begin = 0; // of the member
    std::string_view key;
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char letter = text[i];
        if (letter == '"') {
            const std::size_t start = i++;
            while (i < text.size() && text[i] != '"')
                i += text[i] == '\\' ? 2 : 1;
            if (depth == 1 && key.empty())
                key = text.substr(start + 1, i - start - 1);
        } else if (letter == '{' || letter == '[') {
            if (++depth == 1)
                begin = i + 1;
        } else if (letter == '}' || letter == ']') {
            if (--depth == 0 && !key.empty())
                member(key, i - begin);
        } else if (letter == ',' && depth == 1) {
            member(key, i - begin);
            begin = i + 1;
            key = {};
        }
    }
}

// An empty array where there is no such member.
const Json& memberOf(const Json& json, const char* key) {
    static const Json kNothing = Json::array();
    const auto found = json.find(key);
    return found == json.end() ? kNothing : *found;
}

// The use of every buffer view, by the first that refers to it.
class ViewUses {
public:
    explicit ViewUses(const Json& json)
        : json_(json), uses_(memberOf(json, "bufferViews").size(), Use::Other) {
        for (const Json& mesh : memberOf(json, "meshes"))
            for (const Json& primitive : memberOf(mesh, "primitives"))
                markPrimitive(primitive);
        for (const Json& node : memberOf(json, "nodes"))
            markAccessors(
                memberOf(memberOf(memberOf(node, "extensions"), "EXT_mesh_gpu_instancing"),
                         "attributes"),
                Use::Instances);
        for (const Json& image : memberOf(json, "images"))
            if (image.contains("bufferView"))
                markView(image["bufferView"].get<std::size_t>(), Use::Materials);
    }

    std::uint64_t bytesOf(Use use) const {
        std::uint64_t bytes = 0;
        for (std::size_t view = 0; view < uses_.size(); ++view)
            if (uses_[view] == use)
                bytes += json_["bufferViews"][view].value("byteLength", std::uint64_t{0});
        return bytes;
    }

private:
    void markPrimitive(const Json& primitive) {
        markAccessors(memberOf(primitive, "attributes"), Use::Geometry);
        for (const Json& target : memberOf(primitive, "targets"))
            markAccessors(target, Use::Geometry);
        if (primitive.contains("indices"))
            markAccessor(primitive["indices"].get<std::size_t>(), Use::Geometry);
    }

    void markAccessors(const Json& indices, Use use) {
        for (const Json& accessor : indices)
            markAccessor(accessor.get<std::size_t>(), use);
    }

    void markAccessor(std::size_t accessor, Use use) {
        const Json& one = json_.at("accessors").at(accessor);
        if (one.contains("bufferView"))
            markView(one["bufferView"].get<std::size_t>(), use);
    }

    void markView(std::size_t view, Use use) {
        if (uses_.at(view) == Use::Other)
            uses_[view] = use;
    }

    const Json& json_;
    std::vector<Use> uses_; // [bufferViews]
};

ByteParts splitDocument(std::string_view text, std::uint64_t file_bytes, std::uint64_t bin_bytes) {
    static constexpr std::array<std::string_view, 4> kMaterialMembers = {
        "materials", "textures", "samplers", "images"};
    const Json json = Json::parse(text);
    const ViewUses uses(json);
    ByteParts parts;
    parts.geometry = uses.bytesOf(Use::Geometry);
    parts.instances = uses.bytesOf(Use::Instances);
    parts.materials = uses.bytesOf(Use::Materials);
    const std::uint64_t known = parts.geometry + parts.instances + parts.materials;
    parts.other = bin_bytes - std::min(known, bin_bytes);
    parts.json = file_bytes - bin_bytes;
    forEachTopMember(text, [&](std::string_view key, std::uint64_t bytes) {
        std::uint64_t* const part =
            key == "nodes"                                                       ? &parts.instances
            : std::ranges::find(kMaterialMembers, key) != kMaterialMembers.end() ? &parts.materials
                                                                                 : nullptr;
        if (part) {
            *part += bytes;
            parts.json -= bytes;
        }
    });
    return parts;
}

} // namespace

Result<ByteParts> splitGlb(std::span<const std::byte> file, std::string_view name) {
    const auto refused = [&] {
        return badInput(fmt::format("{}: is no GLB file that can be split into parts", name));
    };
    if (file.size() < kHeaderBytes + kChunkHeaderBytes || std::memcmp(file.data(), "glTF", 4) != 0)
        return refused();
    const std::size_t json_begin = kHeaderBytes + kChunkHeaderBytes;
    const std::size_t json_bytes = wordAt(file, kHeaderBytes);
    if (json_bytes > file.size() - json_begin)
        return refused();
    const std::size_t rest = file.size() - json_begin - json_bytes;
    const std::size_t bin_bytes = rest - std::min(rest, kChunkHeaderBytes);
    const std::string_view text(reinterpret_cast<const char*>(file.data()) + json_begin,
                                json_bytes);
    try {
        return splitDocument(text, file.size(), bin_bytes);
    } catch (const Json::exception&) {
        return refused();
    }
}

Result<ByteParts> splitGlbFile(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    if (!stream)
        return fail(ErrorKind::Failed,
                    fmt::format("{}: cannot be read; check folder and rights", path.string()));
    return splitGlb(std::as_bytes(std::span(text)), path.filename().string());
}

} // namespace lodestone
