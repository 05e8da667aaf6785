#include "scene/gltf/primitive_reader.h"

#include "scene/finite.h"
#include "scene/gltf/draco_reader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace lodestone {

using nlohmann::json;

namespace {

enum Mode : std::uint64_t { kTriangles = 4, kStrip = 5, kFan = 6 };

std::string ofCount(std::uint64_t count, std::uint64_t expected) {
    return std::to_string(count) + " elements but there are " + std::to_string(expected) +
           " positions: re-export the file";
}

Attribute toAttribute(std::string semantic, const AccessorData& data) {
    Attribute attribute;
    attribute.semantic = std::move(semantic);
    attribute.type = data.type;
    attribute.components = data.components;
    attribute.normalized = data.normalized;
    attribute.bytes = data.bytes;
    return attribute;
}

// What an attribute's accessor holds, or what was decoded in its place.
Result<AccessorPtr> vertexData(const std::string& semantic,
                               std::uint64_t accessor,
                               AccessorReader& accessors,
                               const DracoPrimitive& decoded) {
    const auto found = decoded.attributes.find(semantic);
    return found == decoded.attributes.end() ? accessors.read(accessor)
                                             : Result<AccessorPtr>(found->second);
}

Result<std::vector<glm::vec3>> readPositions(const AccessorData& data) {
    if (data.components != 3 || data.matrix)
        return badInput("POSITION is not VEC3: re-export the file");
    std::vector<glm::vec3> positions(data.count);
    if (data.type == ComponentType::Float32) {
        if (!positions.empty())
            std::memcpy(positions.data(), data.bytes.data(), data.bytes.size());
    } else {
        const Attribute attribute = toAttribute("POSITION", data);
        for (std::size_t v = 0; v < positions.size(); ++v)
            for (std::size_t c = 0; c < 3; ++c)
                positions[v][static_cast<int>(c)] = attributeValue(attribute, v, c);
    }
    for (std::size_t v = 0; v < positions.size(); ++v)
        if (!isFinite(positions[v]))
            return badInput("position of vertex " + std::to_string(v) +
                            " is not finite: repair the mesh and export again");
    return positions;
}

Result<std::vector<std::uint32_t>>
readIndices(const json& primitive, AccessorReader& accessors, std::size_t vertex_count) {
    const std::optional<std::uint64_t> accessor = unsignedMember(primitive, "indices");
    if (!accessor) {
        if (vertex_count > std::numeric_limits<std::uint32_t>::max())
            return badInput("has more than 4,294,967,295 vertices: split it");
        std::vector<std::uint32_t> indices(vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    Result<AccessorPtr> data = accessors.read(*accessor);
    if (!data)
        return tl::make_unexpected(data.error());
    const AccessorData& from = **data;
    if (from.components != 1 ||
        (from.type != ComponentType::UInt8 && from.type != ComponentType::UInt16 &&
         from.type != ComponentType::UInt32))
        return badInput("indices are not unsigned integers: re-export the file");
    std::vector<std::uint32_t> indices(from.count);
    const std::size_t size = byteSize(from.type);
    for (std::size_t i = 0; i < indices.size(); ++i) {
        std::memcpy(&indices[i], from.bytes.data() + i * size, size);
        if (indices[i] >= vertex_count)
            return badInput("index " + std::to_string(indices[i]) + " is out of range (" +
                            std::to_string(vertex_count) + " vertices): re-export the file");
    }
    return indices;
}

std::vector<std::uint32_t> trianglesOfStrip(const std::vector<std::uint32_t>& strip) {
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i + 2 < strip.size(); ++i) {
        const std::uint32_t a = strip[i];
        const std::uint32_t b = strip[i + 1 + i % 2];
        const std::uint32_t c = strip[i + 2 - i % 2];
        if (a != b && b != c && c != a)
            triangles.insert(triangles.end(), {a, b, c});
    }
    return triangles;
}

std::vector<std::uint32_t> trianglesOfFan(const std::vector<std::uint32_t>& fan) {
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 1; i + 1 < fan.size(); ++i) {
        const std::uint32_t a = fan[i];
        const std::uint32_t b = fan[i + 1];
        const std::uint32_t c = fan[0];
        if (a != b && b != c && c != a)
            triangles.insert(triangles.end(), {a, b, c});
    }
    return triangles;
}

// Brings indices into one of our modes. Nothing left to draw: empty.
void normaliseIndices(std::uint64_t mode,
                      std::vector<std::uint32_t>& indices,
                      const std::string& name,
                      std::vector<std::string>& notes) {
    if (mode == kStrip)
        indices = trianglesOfStrip(indices);
    else if (mode == kFan)
        indices = trianglesOfFan(indices);
    const std::size_t group = mode >= kTriangles ? 3 : mode == 1 ? 2 : 1;
    if (indices.size() % group != 0) {
        notes.push_back(name + ": the last " + std::to_string(indices.size() % group) +
                        " indices make no whole " + (group == 3 ? "triangle" : "line") +
                        " and were left out");
        indices.resize(indices.size() - indices.size() % group);
    }
    if ((mode == 2 || mode == 3) && indices.size() < 2)
        indices.clear();
}

bool isFiniteAt(const Attribute& attribute, std::size_t vertex) {
    for (std::size_t c = 0; c < attribute.components; ++c)
        if (!std::isfinite(attributeValue(attribute, vertex, c)))
            return false;
    return true;
}

// Sum of the normals of a vertex' triangles, weighted by area.
std::vector<glm::vec3> areaNormals(const Geometry& geometry) {
    std::vector<glm::dvec3> sums(geometry.positions.size(), glm::dvec3(0.0));
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
        const std::uint32_t* t = geometry.indices.data() + i;
        const glm::dvec3 a(geometry.positions[t[0]]);
        const glm::dvec3 normal = glm::cross(glm::dvec3(geometry.positions[t[1]]) - a,
                                             glm::dvec3(geometry.positions[t[2]]) - a);
        for (int corner = 0; corner < 3; ++corner)
            sums[t[corner]] += normal;
    }
    std::vector<glm::vec3> normals(sums.size(), glm::vec3(0.0f, 0.0f, 1.0f));
    for (std::size_t v = 0; v < sums.size(); ++v)
        if (const double length = glm::length(sums[v]); length > 0.0 && std::isfinite(length))
            normals[v] = glm::vec3(sums[v] / length);
    return normals;
}

// Replaces non-finite values: normals by those of the surface, tangents by +x, the rest by 0.
void repairAttributes(PrimitiveData& data,
                      const std::string& name,
                      std::vector<std::string>& notes) {
    Geometry& geometry = data.geometry;
    for (Attribute& attribute : geometry.attributes) {
        if (attribute.type != ComponentType::Float32)
            continue;
        std::vector<std::size_t> bad;
        for (std::size_t v = 0; v < geometry.positions.size(); ++v)
            if (!isFiniteAt(attribute, v))
                bad.push_back(v);
        if (bad.empty())
            continue;
        notes.push_back(name + ": " + std::to_string(bad.size()) + " " + attribute.semantic +
                        " values are not finite and were replaced");
        const bool is_normal = attribute.semantic == "NORMAL" && attribute.components == 3;
        const bool is_tangent = attribute.semantic == "TANGENT" && attribute.components == 4;
        std::vector<glm::vec3> normals;
        if (is_normal && data.mode == PrimitiveMode::Triangles)
            normals = areaNormals(geometry);
        for (const std::size_t v : bad)
            for (std::size_t c = 0; c < attribute.components; ++c) {
                float value = is_tangent && (c == 0 || c == 3) ? 1.0f : 0.0f;
                if (is_normal)
                    value =
                        normals.empty() ? (c == 2 ? 1.0f : 0.0f) : normals[v][static_cast<int>(c)];
                setAttributeValue(attribute, v, c, value);
            }
    }
}

// Normals that are far from unit length draw black or blazing: they get it, if they have any
// length.
void normaliseNormals(Geometry& geometry,
                      const std::string& name,
                      std::vector<std::string>& notes) {
    constexpr float kTolerance = 0.1f;
    for (Attribute& attribute : geometry.attributes) {
        if (attribute.semantic != "NORMAL" || attribute.components != 3)
            continue;
        std::size_t changed = 0;
        for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
            const glm::vec3 normal(attributeValue(attribute, v, 0),
                                   attributeValue(attribute, v, 1),
                                   attributeValue(attribute, v, 2));
            const float length = glm::length(normal);
            if (std::abs(length - 1.0f) <= kTolerance || !(length > 0.0f) || !std::isfinite(length))
                continue;
            for (int c = 0; c < 3; ++c)
                setAttributeValue(attribute, v, static_cast<std::size_t>(c), normal[c] / length);
            ++changed;
        }
        if (changed != 0)
            notes.push_back(name + ": " + std::to_string(changed) +
                            " normals were not of unit length and were made so");
    }
}

// Attributes of a primitive or a morph target. decoded: compressed data that stand in for some of
// its accessors. with_position: morph targets keep POSITION here.
Result<std::vector<Attribute>> readAttributes(const json& map,
                                              AccessorReader& accessors,
                                              const DracoPrimitive& decoded,
                                              std::size_t vertex_count,
                                              bool with_position) {
    std::vector<Attribute> attributes;
    for (const auto& [semantic, accessor] : map.items()) {
        if (semantic == "POSITION" && !with_position)
            continue;
        const std::string shown = semantic.substr(0, 60);
        Result<AccessorPtr> data = vertexData(semantic, *asUnsigned(accessor), accessors, decoded);
        if (!data)
            return badInput(shown + ": " + data.error().message);
        if ((*data)->count != vertex_count)
            return badInput(shown + " has " + ofCount((*data)->count, vertex_count));
        attributes.push_back(toAttribute(semantic, **data));
    }
    return attributes;
}

Result<void>
readMorphTargets(const json& primitive, AccessorReader& accessors, Geometry& geometry) {
    const json* targets = member(primitive, "targets");
    if (targets == nullptr)
        return {};
    for (std::size_t t = 0; t < targets->size(); ++t) {
        Result<std::vector<Attribute>> attributes =
            readAttributes((*targets)[t], accessors, {}, geometry.positions.size(), true);
        if (!attributes)
            return badInput("morph target " + std::to_string(t) + ": " +
                            attributes.error().message);
        for (const Attribute& attribute : *attributes)
            for (std::size_t v = 0; v < geometry.positions.size(); ++v)
                if (attribute.type == ComponentType::Float32 && !isFiniteAt(attribute, v))
                    return badInput("morph target " + std::to_string(t) + ": " +
                                    attribute.semantic + " of vertex " + std::to_string(v) +
                                    " is not finite: repair the mesh and export again");
        geometry.morph_targets.push_back({std::move(*attributes)});
    }
    return {};
}

void keepVertices(Attribute& attribute, const std::vector<std::uint32_t>& kept) {
    const std::size_t stride = attribute.stride();
    for (std::size_t v = 0; v < kept.size(); ++v)
        std::memmove(
            attribute.bytes.data() + v * stride, attribute.bytes.data() + kept[v] * stride, stride);
    attribute.bytes.resize(kept.size() * stride);
    attribute.bytes.shrink_to_fit();
}

} // namespace

Result<std::optional<PrimitiveData>> readPrimitive(const json& primitive,
                                                   AccessorReader& accessors,
                                                   const std::string& name,
                                                   std::vector<std::string>& notes) {
    const json& attributes = primitive["attributes"];
    const std::optional<std::uint64_t> position = unsignedMember(attributes, "POSITION");
    std::uint64_t mode = unsignedMember(primitive, "mode").value_or(kTriangles);
    if (mode > kFan)
        return badInput("mode " + std::to_string(mode) + " is unknown: re-export the file");
    if (!position) {
        notes.push_back(name + " has no POSITION and was left out");
        return std::nullopt;
    }
    Result<std::optional<DracoPrimitive>> compressed = readDraco(primitive, accessors);
    if (!compressed)
        return tl::make_unexpected(compressed.error());
    const DracoPrimitive decoded = compressed->value_or(DracoPrimitive{});
    if (*compressed)
        mode = kTriangles; // strips are decoded as lists
    Result<AccessorPtr> position_data = vertexData("POSITION", *position, accessors, decoded);
    if (!position_data)
        return badInput("POSITION: " + position_data.error().message);
    Result<std::vector<glm::vec3>> positions = readPositions(**position_data);
    if (!positions)
        return tl::make_unexpected(positions.error());
    PrimitiveData data;
    data.mode = mode >= kTriangles ? PrimitiveMode::Triangles : static_cast<PrimitiveMode>(mode);
    data.position_type = (*position_data)->type;
    data.position_normalized = (*position_data)->normalized;
    data.geometry.positions = std::move(*positions);
    const std::size_t vertex_count = data.geometry.positions.size();
    if (*compressed) {
        data.geometry.indices = decoded.indices;
    } else {
        Result<std::vector<std::uint32_t>> indices =
            readIndices(primitive, accessors, vertex_count);
        if (!indices)
            return tl::make_unexpected(indices.error());
        data.geometry.indices = std::move(*indices);
    }
    normaliseIndices(mode, data.geometry.indices, name, notes);
    if (data.geometry.indices.empty()) {
        notes.push_back(name + " has nothing to draw and was left out");
        return std::nullopt;
    }
    Result<std::vector<Attribute>> others =
        readAttributes(attributes, accessors, decoded, vertex_count, false);
    if (!others)
        return tl::make_unexpected(others.error());
    data.geometry.attributes = std::move(*others);
    repairAttributes(data, name, notes);
    normaliseNormals(data.geometry, name, notes);
    if (Result<void> read = readMorphTargets(primitive, accessors, data.geometry); !read)
        return tl::make_unexpected(read.error());
    return data;
}

void dropUnusedVertices(Geometry& geometry) {
    std::vector<std::uint32_t> new_index(geometry.positions.size(), kNone);
    for (const std::uint32_t index : geometry.indices)
        new_index[index] = 0;
    std::vector<std::uint32_t> kept;
    for (std::uint32_t v = 0; v < new_index.size(); ++v)
        if (new_index[v] != kNone) {
            new_index[v] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(v);
        }
    if (kept.size() == geometry.positions.size())
        return;
    for (std::uint32_t& index : geometry.indices)
        index = new_index[index];
    for (std::size_t v = 0; v < kept.size(); ++v)
        geometry.positions[v] = geometry.positions[kept[v]];
    geometry.positions.resize(kept.size());
    geometry.positions.shrink_to_fit();
    for (Attribute& attribute : geometry.attributes)
        keepVertices(attribute, kept);
    for (MorphTarget& target : geometry.morph_targets)
        for (Attribute& attribute : target.attributes)
            keepVertices(attribute, kept);
}

} // namespace lodestone
