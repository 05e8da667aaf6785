#include "scene/expand.h"
#include "tests/scene/scene_fixtures.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

ScenePtr expanded(const ScenePtr& scene) {
    const auto result = expandScene(*scene, {});
    EXPECT_TRUE(result) << (result ? "" : result.error().message);
    return result.value_or(nullptr);
}

TEST(Expand, KeepsTrianglesAndWorldBounds) {
    const ScenePtr scene = fixtures::awkwardInstancesScene();
    const ScenePtr flat = expanded(scene);
    EXPECT_EQ(countScene(*flat).triangles, countScene(*scene).triangles);
    EXPECT_EQ(countScene(*flat).unique_triangles, countScene(*scene).triangles);
    EXPECT_EQ(flat->instances.size(), 1U);
    EXPECT_LE(glm::length(worldBounds(*flat).min - worldBounds(*scene).min), 1e-6);
    EXPECT_LE(glm::length(worldBounds(*flat).max - worldBounds(*scene).max), 1e-6);
}

TEST(Expand, MergesPerMaterialAndNamesAfterIt) {
    const ScenePtr flat = expanded(fixtures::twoMaterialCubeScene());
    ASSERT_EQ(flat->submeshes.size(), 2U);
    EXPECT_EQ(flat->submeshes[0].name, "sides");
    EXPECT_EQ(flat->submeshes[1].name, "caps");
    EXPECT_EQ(flat->submeshes[1].primitives[0].material, 1U);
}

TEST(Expand, ASubmeshThatNothingJoinsKeepsItsName) {
    const ScenePtr scene = fixtures::cubeRowScene(4);
    const ScenePtr flat = expanded(scene);
    ASSERT_EQ(flat->submeshes.size(), 1U);
    EXPECT_EQ(flat->submeshes[0].name, scene->submeshes[0].name);
}

TEST(Expand, FaceAndVertexNormalsStayOutwardUnderShearMirrorAndFlattening) {
    const ScenePtr flat = expanded(fixtures::awkwardInstancesScene());
    const Geometry& geometry = *flat->submeshes[0].primitives[0].geometry;
    const Attribute* normals = findAttribute(geometry.attributes, "NORMAL");
    ASSERT_NE(normals, nullptr);
    ASSERT_EQ(geometry.triangleCount(), 5U * 12U);
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        const std::uint32_t corner = geometry.indices[i];
        const glm::vec3& a = geometry.positions[corner];
        const glm::vec3& b = geometry.positions[geometry.indices[i + 1]];
        const glm::vec3& c = geometry.positions[geometry.indices[i + 2]];
        const glm::vec3 face = glm::normalize(glm::cross(b - a, c - a));
        const glm::vec3 normal(attributeValue(*normals, corner, 0),
                               attributeValue(*normals, corner, 1),
                               attributeValue(*normals, corner, 2));
        EXPECT_GT(glm::dot(face, normal), 0.9999f) << "triangle " << i / 3;
        // 24 vertices an instance, cubes are convex: outward is away from the middle.
        const std::size_t first = corner / 24 * 24;
        glm::vec3 middle(0.0f);
        for (std::size_t v = first; v < first + 24; ++v)
            middle += geometry.positions[v] / 24.0f;
        EXPECT_GT(glm::dot(face, (a + b + c) / 3.0f - middle), 0.0f) << "triangle " << i / 3;
    }
}

TEST(Expand, EveryInstanceIsABlockThatIsNotWelded) {
    const ScenePtr flat = expanded(fixtures::cubeRowScene(4));
    EXPECT_EQ(flat->submeshes[0].primitives[0].geometry->weld_blocks,
              (std::vector<std::uint32_t>{0, 24, 48, 72}));
}

TEST(Expand, PiecesOfOneInstanceInOneMaterialAreOneBlock) {
    auto scene = std::make_shared<Scene>(*fixtures::twoMaterialCubeScene());
    for (Primitive& primitive : scene->submeshes[0].primitives)
        primitive.material = 0;
    const ScenePtr flat = expanded(scene);
    ASSERT_EQ(flat->submeshes.size(), 1U);
    const Geometry& geometry = *flat->submeshes[0].primitives[0].geometry;
    EXPECT_EQ(geometry.positions.size(), 24U);
    EXPECT_EQ(geometry.weld_blocks, std::vector<std::uint32_t>{0});
}

TEST(Expand, QuantizedNormalsStayUnit) {
    auto scene = std::make_shared<Scene>(*fixtures::awkwardInstancesScene());
    Geometry geometry = *scene->submeshes[0].primitives[0].geometry;
    for (Attribute& attribute : geometry.attributes)
        if (attribute.semantic == "NORMAL") {
            const Attribute floats = attribute;
            attribute.type = ComponentType::Int8;
            attribute.normalized = true;
            attribute.bytes.assign(geometry.positions.size() * attribute.stride(), std::byte{});
            for (std::size_t v = 0; v < geometry.positions.size(); ++v)
                for (std::size_t c = 0; c < 3; ++c)
                    setAttributeValue(attribute, v, c, attributeValue(floats, v, c));
        }
    scene->submeshes[0].primitives[0].geometry = std::make_shared<const Geometry>(geometry);
    const ScenePtr flat = expanded(scene);
    const Geometry& merged = *flat->submeshes[0].primitives[0].geometry;
    const Attribute* normals = findAttribute(merged.attributes, "NORMAL");
    ASSERT_NE(normals, nullptr);
    EXPECT_EQ(normals->type, ComponentType::Int8);
    for (std::size_t v = 0; v < merged.positions.size(); ++v) {
        const glm::vec3 normal(attributeValue(*normals, v, 0),
                               attributeValue(*normals, v, 1),
                               attributeValue(*normals, v, 2));
        EXPECT_NEAR(glm::length(normal), 1.0f, 0.02f) << "vertex " << v;
    }
}

TEST(Expand, StopsWhenAsked) {
    std::stop_source stop;
    stop.request_stop();
    const auto result = expandScene(*fixtures::cubeRowScene(10), {stop.get_token(), {}});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().kind, ErrorKind::Cancelled);
}

} // namespace
} // namespace lodestone
