#include "tests/scene/scene_fixtures.h"

#include "scene/scene_builder.h"

#include <array>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

namespace lodestone::fixtures {

namespace {

template <class T>
Attribute
makeAttribute(std::string semantic, std::uint8_t components, const std::vector<T>& values) {
    Attribute attribute;
    attribute.semantic = std::move(semantic);
    attribute.components = components;
    attribute.bytes.resize(values.size() * sizeof(T));
    std::memcpy(attribute.bytes.data(), values.data(), attribute.bytes.size());
    return attribute;
}

// Area-weighted normals of the faces around each vertex.
std::vector<glm::vec3> normalsOf(const Geometry& geometry) {
    std::vector<glm::vec3> normals(geometry.positions.size(), glm::vec3(0.0f));
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
        const glm::vec3& a = geometry.positions[geometry.indices[i]];
        const glm::vec3& b = geometry.positions[geometry.indices[i + 1]];
        const glm::vec3& c = geometry.positions[geometry.indices[i + 2]];
        const glm::vec3 normal = glm::cross(b - a, c - a);
        for (std::size_t corner = 0; corner < 3; ++corner)
            normals[geometry.indices[i + corner]] += normal;
    }
    for (glm::vec3& normal : normals)
        normal = glm::length(normal) > 0.0f ? glm::normalize(normal) : glm::vec3(0, 0, 1);
    return normals;
}

void addCubeSide(Geometry& to, const glm::vec3& normal, const glm::vec3& right) {
    const glm::vec3 up = glm::cross(normal, right);
    const auto first = static_cast<std::uint32_t>(to.positions.size());
    for (const glm::vec2 corner :
         {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)})
        to.positions.push_back((normal + corner.x * right + corner.y * up) * 0.5f);
    for (const std::uint32_t index : {0U, 1U, 2U, 0U, 2U, 3U})
        to.indices.push_back(first + index);
}

Geometry cubeSides(std::span<const glm::vec3> normals) {
    Geometry geometry;
    for (const glm::vec3& normal : normals)
        addCubeSide(geometry, normal, glm::vec3(normal.y, normal.z, normal.x));
    return geometry;
}

constexpr std::array<glm::vec3, 4> kSides{
    glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)};
constexpr std::array<glm::vec3, 2> kCaps{glm::vec3(0, 1, 0), glm::vec3(0, -1, 0)};

GeometryPtr finished(Geometry geometry) {
    return makeGeometry(std::move(geometry.positions), std::move(geometry.indices));
}

Submesh submeshOf(std::string name, GeometryPtr geometry) {
    Primitive primitive;
    primitive.geometry = std::move(geometry);
    return {std::move(name), {std::move(primitive)}};
}

// Red, green, blue, white.
constexpr std::array<unsigned char, 75> kPng{
    0x89, 0x50, 0x4E, 0x47, 0x0D, 0x0A, 0x1A, 0x0A, 0x00, 0x00, 0x00, 0x0D, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x02, 0x08, 0x02, 0x00, 0x00, 0x00, 0xFD,
    0xD4, 0x9A, 0x73, 0x00, 0x00, 0x00, 0x12, 0x49, 0x44, 0x41, 0x54, 0x78, 0xDA, 0x63, 0xF8,
    0xCF, 0xC0, 0xC0, 0x00, 0xC2, 0x0C, 0xFF, 0x81, 0x00, 0x00, 0x1F, 0xEE, 0x05, 0xFB, 0xF1,
    0xAB, 0xBA, 0x77, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4E, 0x44, 0xAE, 0x42, 0x60, 0x82};

} // namespace

GeometryPtr makeBareGeometry(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices) {
    Geometry geometry;
    geometry.positions = std::move(positions);
    geometry.indices = std::move(indices);
    return std::make_shared<const Geometry>(std::move(geometry));
}

GeometryPtr makeGeometry(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices) {
    Geometry geometry;
    geometry.positions = std::move(positions);
    geometry.indices = std::move(indices);
    std::vector<glm::vec2> texcoords;
    for (const glm::vec3& position : geometry.positions)
        texcoords.emplace_back(position);
    geometry.attributes.push_back(makeAttribute("NORMAL", 3, normalsOf(geometry)));
    geometry.attributes.push_back(makeAttribute("TEXCOORD_0", 2, texcoords));
    return std::make_shared<const Geometry>(std::move(geometry));
}

GeometryPtr triangleGeometry() {
    return makeGeometry({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
}

GeometryPtr cubeGeometry() {
    std::vector<glm::vec3> normals(kSides.begin(), kSides.end());
    normals.insert(normals.end(), kCaps.begin(), kCaps.end());
    return finished(cubeSides(normals));
}

GeometryPtr gridGeometry(std::uint32_t quads_per_side) {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> indices;
    const std::uint32_t row = quads_per_side + 1;
    for (std::uint32_t y = 0; y < row; ++y)
        for (std::uint32_t x = 0; x < row; ++x)
            positions.emplace_back(glm::vec3(x, y, 0) / static_cast<float>(quads_per_side));
    for (std::uint32_t y = 0; y < quads_per_side; ++y)
        for (std::uint32_t x = 0; x < quads_per_side; ++x) {
            const std::uint32_t corner = y * row + x;
            for (const std::uint32_t offset : {0U, 1U, row + 1, 0U, row + 1, row})
                indices.push_back(corner + offset);
        }
    return makeGeometry(std::move(positions), std::move(indices));
}

ScenePtr sceneOf(GeometryPtr geometry, std::span<const glm::dmat4> transforms) {
    SceneBuilder builder("fixture");
    const std::uint32_t submesh = builder.addSubmesh(submeshOf("shape", std::move(geometry)));
    for (std::size_t i = 0; i < transforms.size(); ++i)
        builder.addNode("instance " + std::to_string(i), kNone, transforms[i], submesh);
    if (transforms.empty())
        builder.addNode("instance", kNone, glm::dmat4(1.0), submesh);
    return builder.finish();
}

ScenePtr triangleScene() {
    return sceneOf(triangleGeometry());
}

ScenePtr cubeScene() {
    return sceneOf(cubeGeometry());
}

ScenePtr twoMaterialCubeScene() {
    SceneBuilder builder("two-material cube");
    Material sides;
    sides.name = "sides";
    sides.base_color = glm::vec4(0.8f, 0.2f, 0.2f, 1.0f);
    Material caps;
    caps.name = "caps";
    caps.base_color = glm::vec4(0.2f, 0.2f, 0.8f, 1.0f);
    Submesh submesh;
    submesh.name = "cube";
    Primitive primitive;
    primitive.geometry = finished(cubeSides(kSides));
    primitive.material = builder.addMaterial(sides);
    submesh.primitives.push_back(primitive);
    primitive.geometry = finished(cubeSides(kCaps));
    primitive.material = builder.addMaterial(caps);
    submesh.primitives.push_back(primitive);
    builder.addNode("cube", kNone, glm::dmat4(1.0), builder.addSubmesh(std::move(submesh)));
    return builder.finish();
}

ScenePtr gridScene(std::uint32_t quads_per_side) {
    return sceneOf(gridGeometry(quads_per_side));
}

ScenePtr awkwardInstancesScene() {
    const glm::dmat4 identity(1.0);
    const glm::dmat4 turned = glm::rotate(
        glm::translate(identity, glm::dvec3(3, 1, 0)), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
    const glm::dmat4 mirrored =
        glm::scale(glm::translate(identity, glm::dvec3(6, 0, 0)), glm::dvec3(-1, 1, 2));
    glm::dmat4 sheared = glm::translate(identity, glm::dvec3(9, 0, 0));
    sheared[1] = glm::dvec4(0.75, 1.0, 0.25, 0.0);
    const glm::dmat4 flat =
        glm::scale(glm::translate(identity, glm::dvec3(12, 0, 0)), glm::dvec3(1, 0.01, 1));
    const std::array transforms{identity, turned, mirrored, sheared, flat};
    return sceneOf(cubeGeometry(), transforms);
}

ScenePtr texturedQuadScene() {
    SceneBuilder builder("textured quad");
    Image image;
    image.name = "four colours";
    image.mime_type = "image/png";
    const auto bytes = std::as_bytes(std::span(kPng));
    image.bytes = std::make_shared<const std::vector<std::byte>>(bytes.begin(), bytes.end());
    Material material;
    material.name = "textured";
    material.base_color_texture.image = builder.addImage(std::move(image));
    material.base_color_texture.nearest = true;
    Submesh submesh = submeshOf("quad", gridGeometry(1));
    submesh.primitives[0].material = builder.addMaterial(material);
    builder.addNode("quad", kNone, glm::dmat4(1.0), builder.addSubmesh(std::move(submesh)));
    return builder.finish();
}

ScenePtr cubeRowScene(std::uint32_t count) {
    SceneBuilder builder("row of cubes");
    const std::uint32_t submesh = builder.addSubmesh(submeshOf("cube", cubeGeometry()));
    for (std::uint32_t i = 0; i < count; ++i)
        builder.addNode("cube " + std::to_string(i),
                        kNone,
                        glm::translate(glm::dmat4(1.0), glm::dvec3(2.0 * i, 0.0, 0.0)),
                        submesh);
    return builder.finish();
}

} // namespace lodestone::fixtures
