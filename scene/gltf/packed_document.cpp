#include "scene/gltf/packed_document.h"

#include "scene/gltf/writer_carried.h"
#include "scene/gltf/writer_references.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lodestone {

using nlohmann::json;

namespace {

constexpr int kTriangles = 4;

void note(std::vector<AccessorUse>& uses,
          const json& number,
          AccessorUse::Kind kind,
          const std::string& semantic,
          std::uint32_t node = kNone) {
    AccessorUse& use = uses[number.get<std::size_t>()];
    ++use.users;
    if (use.kind != AccessorUse::Kind::None)
        return;
    use.kind = kind;
    use.semantic = semantic;
    use.node = node;
}

void notePrimitive(std::vector<AccessorUse>& uses, const json& primitive) {
    for (const auto& [semantic, number] : primitive["attributes"].items())
        note(uses, number, AccessorUse::Kind::Vertex, semantic);
    if (const auto targets = primitive.find("targets"); targets != primitive.end())
        for (const json& target : *targets)
            for (const auto& [semantic, number] : target.items())
                note(uses, number, AccessorUse::Kind::Vertex, "morphed " + semantic);
    if (const auto indices = primitive.find("indices"); indices != primitive.end())
        note(uses,
             *indices,
             primitive.value("mode", kTriangles) == kTriangles ? AccessorUse::Kind::Triangles
                                                               : AccessorUse::Kind::Indices,
             {});
}

double stretch(const json& node) {
    double most = 0.0;
    if (const auto scale = node.find("scale"); scale != node.end()) {
        for (const json& s : *scale)
            most = std::max(most, std::abs(s.get<double>()));
        return most;
    }
    const auto matrix = node.find("matrix");
    if (matrix == node.end())
        return 1.0;
    for (std::size_t column = 0; column < 3; ++column) {
        double squared = 0.0;
        for (std::size_t row = 0; row < 3; ++row)
            squared += std::pow((*matrix)[column * 4 + row].get<double>(), 2.0);
        most = std::max(most, std::sqrt(squared));
    }
    return most;
}

} // namespace

std::vector<AccessorUse> accessorUses(const PackedDocument& document) {
    const json& root = document.json;
    std::vector<AccessorUse> uses(root.contains("accessors") ? root["accessors"].size() : 0);
    if (root.contains("meshes"))
        for (const json& mesh : root["meshes"])
            for (const json& primitive : mesh["primitives"])
                notePrimitive(uses, primitive);
    for (std::uint32_t n = 0; root.contains("nodes") && n < root["nodes"].size(); ++n) {
        const json& node = root["nodes"][n];
        const auto extensions = node.find("extensions");
        if (extensions != node.end() && extensions->contains(kGpuInstancing))
            for (const auto& [semantic, number] :
                 (*extensions)[kGpuInstancing]["attributes"].items())
                note(uses, number, AccessorUse::Kind::Row, semantic, n);
    }
    for (std::size_t a = 0; a < uses.size(); ++a)
        if (root["accessors"][a].value("bufferView", 0U) < document.first_view ||
            !root["accessors"][a].contains("bufferView"))
            uses[a].kind = AccessorUse::Kind::None;
    return uses;
}

StridedElements elementsOf(const PackedDocument& document, std::size_t accessor) {
    const json& entry = document.json["accessors"][accessor];
    const json& view = document.json["bufferViews"][entry["bufferView"].get<std::size_t>()];
    StridedElements elements;
    elements.count = entry["count"].get<std::size_t>();
    elements.stride = view.value("byteStride", elementBytes(entry));
    const std::size_t offset =
        view.value("byteOffset", std::size_t{0}) + entry.value("byteOffset", std::size_t{0});
    elements.bytes = std::span(document.binary).subspan(offset, elements.count * elements.stride);
    return elements;
}

std::vector<float> floatsOf(const PackedDocument& document, std::size_t accessor) {
    const json& entry = document.json["accessors"][accessor];
    const StridedElements elements = elementsOf(document, accessor);
    Attribute attribute;
    attribute.type = static_cast<ComponentType>(entry["componentType"].get<int>());
    attribute.components = static_cast<std::uint8_t>(componentsOf(entry));
    attribute.normalized = entry.value("normalized", false);
    const std::size_t packed = attribute.stride();
    attribute.bytes.resize(elements.count * packed);
    for (std::size_t i = 0; i < elements.count; ++i)
        std::memcpy(attribute.bytes.data() + i * packed,
                    elements.bytes.data() + i * elements.stride,
                    packed);
    std::vector<float> values;
    values.reserve(elements.count * attribute.components);
    for (std::size_t i = 0; i < elements.count; ++i)
        for (std::size_t c = 0; c < attribute.components; ++c)
            values.push_back(attributeValue(attribute, i, c));
    return values;
}

std::vector<std::uint32_t> indicesOf(const PackedDocument& document, std::size_t accessor) {
    const StridedElements elements = elementsOf(document, accessor);
    std::vector<std::uint32_t> indices(elements.count, 0);
    for (std::size_t i = 0; i < elements.count; ++i) // little-endian, as glTF
        std::memcpy(&indices[i], elements.bytes.data() + i * elements.stride, elements.stride);
    return indices;
}

std::size_t componentsOf(const json& accessor) {
    const std::string type = accessor["type"];
    if (type == "SCALAR")
        return 1;
    const auto size = static_cast<std::size_t>(type.back() - '0');
    return type.starts_with("MAT") ? size * size : size;
}

std::vector<double> nodeStretches(const json& document) {
    const std::size_t count = document.contains("nodes") ? document["nodes"].size() : 0;
    std::vector<std::size_t> parent(count, count);
    for (std::size_t n = 0; n < count; ++n)
        if (const auto children = document["nodes"][n].find("children");
            children != document["nodes"][n].end())
            for (const json& child : *children)
                parent[child.get<std::size_t>()] = n;
    std::vector<double> stretches(count, 1.0);
    for (std::size_t n = 0; n < count; ++n)
        for (std::size_t up = n; up < count; up = parent[up])
            stretches[n] *= stretch(document["nodes"][up]);
    return stretches;
}

double largestRowScale(const PackedDocument& document, std::size_t node) {
    const json& extensions = document.json["nodes"][node].value("extensions", json::object());
    const auto instancing = extensions.find(kGpuInstancing);
    if (instancing == extensions.end() || !(*instancing)["attributes"].contains("SCALE"))
        return 1.0;
    double most = 0.0;
    for (const float s : floatsOf(document, (*instancing)["attributes"]["SCALE"]))
        most = std::max(most, static_cast<double>(std::abs(s)));
    return most;
}

void padTo4(std::vector<std::byte>& bytes) {
    bytes.resize((bytes.size() + 3) & ~std::size_t{3});
}

void requireExtension(json& document, const char* name) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        json& names = document[list];
        if (std::ranges::find(names, json(name)) == names.end())
            names.push_back(name);
    }
}

} // namespace lodestone
