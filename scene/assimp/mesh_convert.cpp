#include "scene/assimp/mesh_convert.h"

#include "scene/finite.h"

#include <algorithm>
#include <assimp/mesh.h>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

namespace lodestone {

namespace {

template <class Value>
void put(std::vector<std::byte>& bytes, std::size_t index, const Value& value) {
    std::memcpy(bytes.data() + index * sizeof(Value), &value, sizeof(Value));
}

Attribute makeAttribute(std::string semantic,
                        ComponentType type,
                        std::uint8_t components,
                        std::size_t vertex_count) {
    Attribute attribute;
    attribute.semantic = std::move(semantic);
    attribute.type = type;
    attribute.components = components;
    attribute.bytes.resize(vertex_count * attribute.stride());
    return attribute;
}

float finiteOr(float value, float fallback) {
    return std::isfinite(value) ? value : fallback;
}

Attribute normalsOf(const aiMesh& mesh) {
    Attribute attribute = makeAttribute("NORMAL", ComponentType::Float32, 3, mesh.mNumVertices);
    for (std::size_t v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& from = mesh.mNormals[v];
        glm::vec3 normal(from.x, from.y, from.z);
        const float length = glm::length(normal);
        // glTF wants unit normals; a normal that says nothing points up.
        normal = std::isfinite(length) && length > 0.0f ? normal / length : glm::vec3(0, 1, 0);
        put(attribute.bytes, v, normal);
    }
    return attribute;
}

Attribute texcoordsOf(const aiMesh& mesh, unsigned set, unsigned written_set) {
    Attribute attribute = makeAttribute(
        "TEXCOORD_" + std::to_string(written_set), ComponentType::Float32, 2, mesh.mNumVertices);
    for (std::size_t v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& from = mesh.mTextureCoords[set][v];
        put(attribute.bytes, v, glm::vec2(finiteOr(from.x, 0.0f), 1.0f - finiteOr(from.y, 0.0f)));
    }
    return attribute;
}

bool isByte(float value) {
    const float scaled = value * 255.0f;
    return std::abs(scaled - std::round(scaled)) < 1e-3f && scaled > -0.5f && scaled < 255.5f;
}

Attribute colorsOf(const aiMesh& mesh, unsigned set, unsigned written_set) {
    const std::span<const aiColor4D> colors(mesh.mColors[set], mesh.mNumVertices);
    const bool bytes = std::ranges::all_of(colors, [](const aiColor4D& c) {
        return isByte(c.r) && isByte(c.g) && isByte(c.b) && isByte(c.a);
    });
    Attribute attribute = makeAttribute("COLOR_" + std::to_string(written_set),
                                        bytes ? ComponentType::UInt8 : ComponentType::Float32,
                                        4,
                                        colors.size());
    attribute.normalized = bytes;
    for (std::size_t v = 0; v < colors.size(); ++v)
        for (unsigned c = 0; c < 4; ++c)
            setAttributeValue(
                attribute, v, c, std::clamp(finiteOr(colors[v][c], 1.0f), 0.0f, 1.0f));
    return attribute;
}

std::vector<Attribute> attributesOf(const aiMesh& mesh, const MeshOptions& options) {
    std::vector<Attribute> attributes;
    if (options.keep_normals && mesh.HasNormals())
        attributes.push_back(normalsOf(mesh));
    unsigned written = 0;
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_TEXTURECOORDS; ++set)
        if (mesh.HasTextureCoords(set))
            attributes.push_back(texcoordsOf(mesh, set, written++));
    written = 0;
    for (unsigned set = 0; set < AI_MAX_NUMBER_OF_COLOR_SETS; ++set)
        if (mesh.HasVertexColors(set))
            attributes.push_back(colorsOf(mesh, set, written++));
    return attributes;
}

// Every vertex as one row of bytes: position, then attributes.
struct Rows {
    std::size_t stride = 0;
    std::vector<std::byte> bytes;

    std::string_view row(std::size_t vertex) const {
        return {reinterpret_cast<const char*>(bytes.data()) + vertex * stride, stride};
    }
};

Rows rowsOf(const Geometry& geometry) {
    Rows rows;
    rows.stride = sizeof(glm::vec3);
    for (const Attribute& attribute : geometry.attributes)
        rows.stride += attribute.stride();
    rows.bytes.resize(rows.stride * geometry.positions.size());
    std::size_t column = 0;
    const auto copy_column = [&](const void* from, std::size_t size) {
        for (std::size_t v = 0; v < geometry.positions.size(); ++v)
            std::memcpy(rows.bytes.data() + v * rows.stride + column,
                        static_cast<const std::byte*>(from) + v * size,
                        size);
        column += size;
    };
    copy_column(geometry.positions.data(), sizeof(glm::vec3));
    for (const Attribute& attribute : geometry.attributes)
        copy_column(attribute.bytes.data(), attribute.stride());
    return rows;
}

// The vertices that kept lists, in that order.
Geometry pickVertices(const Geometry& from, std::span<const std::uint32_t> kept) {
    Geometry to;
    to.positions.reserve(kept.size());
    for (const std::uint32_t v : kept)
        to.positions.push_back(from.positions[v]);
    for (const Attribute& attribute : from.attributes) {
        Attribute picked = attribute;
        picked.bytes.resize(kept.size() * attribute.stride());
        for (std::size_t i = 0; i < kept.size(); ++i)
            std::memcpy(picked.bytes.data() + i * attribute.stride(),
                        attribute.bytes.data() + kept[i] * attribute.stride(),
                        attribute.stride());
        to.attributes.push_back(std::move(picked));
    }
    return to;
}

// indices refer to `all`; the result holds each distinct vertex once, in order of first use.
Geometry joined(const Geometry& all, std::span<const std::uint32_t> indices) {
    const Rows rows = rowsOf(all);
    std::unordered_map<std::string_view, std::uint32_t> known;
    known.reserve(all.positions.size());
    std::vector<std::uint32_t> kept;
    std::vector<std::uint32_t> new_indices;
    new_indices.reserve(indices.size());
    std::vector<std::uint32_t> new_of(all.positions.size(), kNone);
    for (const std::uint32_t index : indices) {
        if (new_of[index] == kNone) {
            const auto [found, is_new] =
                known.try_emplace(rows.row(index), static_cast<std::uint32_t>(kept.size()));
            if (is_new)
                kept.push_back(index);
            new_of[index] = found->second;
        }
        new_indices.push_back(new_of[index]);
    }
    Geometry geometry = pickVertices(all, kept);
    geometry.indices = std::move(new_indices);
    return geometry;
}

Primitive makePrimitive(PrimitiveMode mode, Geometry geometry, std::uint32_t material) {
    Primitive primitive;
    primitive.mode = mode;
    primitive.geometry = std::make_shared<const Geometry>(std::move(geometry));
    primitive.material = material;
    return primitive;
}

// Faces by their number of corners: [0] points, [1] lines, [2] triangles.
Result<std::array<std::vector<std::uint32_t>, 3>> facesOf(const aiMesh& mesh) {
    std::array<std::vector<std::uint32_t>, 3> corners;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        const aiFace& face = mesh.mFaces[f];
        if (face.mNumIndices == 0)
            continue;
        if (face.mNumIndices > 3)
            return badInput("face " + std::to_string(f) +
                            " is a polygon that cannot be split into triangles; triangulate the "
                            "mesh and export again");
        for (unsigned c = 0; c < face.mNumIndices; ++c) {
            if (face.mIndices[c] >= mesh.mNumVertices)
                return badInput("face " + std::to_string(f) + " refers to vertex " +
                                std::to_string(face.mIndices[c]) + " of " +
                                std::to_string(mesh.mNumVertices) +
                                "; repair the mesh and export again");
            corners[face.mNumIndices - 1].push_back(face.mIndices[c]);
        }
    }
    // A point cloud has vertices alone.
    if (mesh.mNumFaces == 0) {
        corners[0].resize(mesh.mNumVertices);
        std::iota(corners[0].begin(), corners[0].end(), 0u);
    }
    return corners;
}

} // namespace

Result<std::vector<Primitive>>
convertMesh(const aiMesh& mesh,
            const MeshOptions& options,
            const std::function<std::uint32_t(std::uint32_t)>& material_of) {
    const auto faces = facesOf(mesh);
    if (!faces)
        return tl::unexpected(faces.error());
    Geometry all;
    all.positions.reserve(mesh.mNumVertices);
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
        const aiVector3D& from = mesh.mVertices[v];
        const glm::vec3 position(from.x, from.y, from.z);
        if (!isFinite(position))
            return badInput("the position of vertex " + std::to_string(v) +
                            " is not a finite number; repair the mesh and export again");
        all.positions.push_back(position);
    }
    all.attributes = attributesOf(mesh, options);
    const std::uint32_t material = material_of(mesh.mMaterialIndex);
    const auto& [points, lines, triangles] = *faces;
    std::vector<Primitive> primitives;
    if (!triangles.empty())
        primitives.push_back(
            makePrimitive(PrimitiveMode::Triangles, joined(all, triangles), material));
    if (!lines.empty())
        primitives.push_back(makePrimitive(PrimitiveMode::Lines, joined(all, lines), material));
    if (!points.empty()) {
        Geometry geometry = pickVertices(all, points);
        geometry.indices.resize(points.size());
        std::iota(geometry.indices.begin(), geometry.indices.end(), 0u);
        primitives.push_back(makePrimitive(PrimitiveMode::Points, std::move(geometry), material));
    }
    return primitives;
}

} // namespace lodestone
