#include "scene/gltf/source_document.h"
#include "scene/lod.h"
#include "scene/scene_builder.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

using namespace lodestone;

namespace {

Attribute attributeOf(ComponentType type, bool normalized) {
    Attribute attribute;
    attribute.type = type;
    attribute.components = 2;
    attribute.normalized = normalized;
    attribute.bytes.resize(2 * attribute.stride());
    return attribute;
}

Submesh triangleSubmesh(const std::string& name) {
    auto geometry = std::make_shared<Geometry>();
    geometry->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    geometry->indices = {0, 1, 2};
    Submesh submesh;
    submesh.name = name;
    submesh.primitives.push_back({.geometry = std::move(geometry)});
    return submesh;
}

glm::dmat4 moved(double x, double y, double z) {
    return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, z));
}

} // namespace

TEST(Attribute, NormalizedIntegersDecodeByTheFormatsRule) {
    Attribute attribute = attributeOf(ComponentType::Int8, true);
    attribute.bytes[0] = std::byte{0x80}; // -128 clamps to -1
    attribute.bytes[1] = std::byte{127};
    EXPECT_EQ(attributeValue(attribute, 0, 0), -1.0f);
    EXPECT_EQ(attributeValue(attribute, 0, 1), 1.0f);
}

TEST(Attribute, WhatIsSetIsReadBackWithinHalfAStep) {
    for (const ComponentType type : {ComponentType::Int8,
                                     ComponentType::UInt8,
                                     ComponentType::Int16,
                                     ComponentType::UInt16,
                                     ComponentType::Float32}) {
        Attribute attribute = attributeOf(type, type != ComponentType::Float32);
        setAttributeValue(attribute, 1, 0, 0.3f);
        EXPECT_NEAR(attributeValue(attribute, 1, 0), 0.3f, 0.5f / 127.0f);
        EXPECT_EQ(attributeValue(attribute, 0, 0), 0.0f);
    }
}

TEST(Attribute, ValuesBeyondTheTypeAreClamped) {
    Attribute attribute = attributeOf(ComponentType::UInt8, false);
    setAttributeValue(attribute, 0, 0, 300.0f);
    setAttributeValue(attribute, 0, 1, -3.0f);
    EXPECT_EQ(attributeValue(attribute, 0, 0), 255.0f);
    EXPECT_EQ(attributeValue(attribute, 0, 1), 0.0f);
}

TEST(Decompose, TranslationRotationAndScaleComeBack) {
    Trs trs;
    trs.translation = {1, -2, 3};
    trs.rotation = glm::angleAxis(2.5, glm::normalize(glm::dvec3(1, 2, -3)));
    trs.scale = {2, 0.5, 7};
    Trs found;
    ASSERT_TRUE(decompose(toMatrix(trs), found));
    const glm::dmat4 difference = toMatrix(found) - toMatrix(trs);
    for (int column = 0; column < 4; ++column)
        EXPECT_LT(glm::length(difference[column]), 1e-12);
}

TEST(Decompose, AMirrorGetsOneNegativeScale) {
    Trs found;
    ASSERT_TRUE(decompose(glm::scale(glm::dmat4(1.0), glm::dvec3(1, -3, 2)), found));
    EXPECT_LT(found.scale.x * found.scale.y * found.scale.z, 0.0);
    EXPECT_NEAR(toMatrix(found)[1][1], -3.0, 1e-12);
}

TEST(Decompose, ShearAndFlattenedMatricesAreRefused) {
    glm::dmat4 shear(1.0);
    shear[1][0] = 0.01;
    Trs found;
    EXPECT_FALSE(decompose(shear, found));
    EXPECT_FALSE(decompose(glm::scale(glm::dmat4(1.0), glm::dvec3(1, 0, 1)), found));
}

TEST(SceneBuilder, InstancesAreSortedBySubmeshAndPlacedByTheWholePath) {
    SceneBuilder builder("made");
    const std::uint32_t a = builder.addSubmesh(triangleSubmesh("a"));
    const std::uint32_t b = builder.addSubmesh(triangleSubmesh("b"));
    const std::uint32_t root = builder.addNode("root", kNone, moved(1, 0, 0));
    builder.addNode("first", root, moved(0, 2, 0), b);
    builder.addNode("second", root, moved(0, 0, 3), a);
    const ScenePtr scene = builder.finish();
    ASSERT_EQ(scene->instances.size(), 2u);
    EXPECT_EQ(scene->instances[0].submesh, a);
    EXPECT_EQ(glm::dvec3(scene->instances[0].transform[3]), glm::dvec3(1, 0, 3));
    EXPECT_EQ(glm::dvec3(scene->instances[1].transform[3]), glm::dvec3(1, 2, 0));
    EXPECT_FALSE(scene->nodes[root].foldable);
    EXPECT_TRUE(scene->nodes[1].foldable);
}

TEST(SceneBuilder, TheDocumentNamesWhatTheSceneHolds) {
    SceneBuilder builder("made");
    Image image;
    image.mime_type = "image/png";
    image.bytes = std::make_shared<const std::vector<std::byte>>(3);
    Material material;
    material.name = "bark";
    material.base_color = {0.5f, 0.5f, 0.5f, 1.0f};
    material.alpha_mode = AlphaMode::Mask;
    material.base_color_texture.image = builder.addImage(image);
    material.base_color_texture.wrap_u = TextureWrap::ClampToEdge;
    Submesh submesh = triangleSubmesh("blade");
    submesh.primitives[0].material = builder.addMaterial(material);
    const std::uint32_t drawn = builder.addSubmesh(submesh);
    glm::dmat4 shear = moved(1, 2, 3);
    shear[1][0] = 0.5;
    builder.addNode("trs", kNone, moved(1, 2, 3), drawn);
    builder.addNode("sheared", kNone, shear, drawn);
    builder.addCamera({}, builder.addNode("eye"));
    const ScenePtr scene = builder.finish();

    const nlohmann::json& document = scene->source->json;
    EXPECT_EQ(document["scenes"][0]["nodes"], nlohmann::json({0, 1, 2}));
    EXPECT_EQ(document["nodes"][0]["translation"], nlohmann::json({1.0, 2.0, 3.0}));
    EXPECT_FALSE(document["nodes"][0].contains("matrix"));
    EXPECT_EQ(document["nodes"][1]["matrix"].size(), 16u);
    EXPECT_EQ(document["nodes"][2]["camera"], 0);
    EXPECT_EQ(document["meshes"][0]["primitives"][0]["material"], 0);
    const nlohmann::json& words = document["materials"][0];
    EXPECT_EQ(words["alphaMode"], "MASK");
    EXPECT_EQ(words["pbrMetallicRoughness"]["baseColorTexture"]["index"], 0);
    EXPECT_EQ(document["textures"][0]["source"], 0);
    EXPECT_EQ(document["samplers"][0]["wrapS"], 33071);
    EXPECT_EQ(document["images"][0]["mimeType"], "image/png");
    EXPECT_FALSE(document["images"][0].contains("uri"));
}

TEST(Scene, CountsTellInstancedAndUniqueTrianglesApart) {
    SceneBuilder builder("made");
    const std::uint32_t submesh = builder.addSubmesh(triangleSubmesh("a"));
    builder.addSubmesh(triangleSubmesh("never drawn"));
    for (int i = 0; i < 7; ++i)
        builder.addNode("", kNone, moved(i, 0, 0), submesh);
    const SceneCounts counts = countScene(*builder.finish());
    EXPECT_EQ(counts.submeshes, 1u);
    EXPECT_EQ(counts.instances, 7u);
    EXPECT_EQ(counts.triangles, 7u);
    EXPECT_EQ(counts.unique_triangles, 1u);
    EXPECT_EQ(counts.vertices, 3u);
}

TEST(Scene, WorldBoundsFollowEveryInstance) {
    SceneBuilder builder("made");
    const std::uint32_t submesh = builder.addSubmesh(triangleSubmesh("a"));
    builder.addNode("", kNone, moved(-5, 0, 0), submesh);
    builder.addNode("", kNone, glm::scale(glm::dmat4(1.0), glm::dvec3(1, -4, 1)), submesh);
    const Bounds bounds = worldBounds(*builder.finish());
    EXPECT_EQ(bounds.min, glm::dvec3(-5, -4, 0));
    EXPECT_EQ(bounds.max, glm::dvec3(1, 1, 0));
}

TEST(Scene, RobustBoundsLeaveAFarOutlierOut) {
    Submesh submesh;
    auto geometry = std::make_shared<Geometry>();
    for (int i = 0; i < 1000; ++i)
        geometry->positions.emplace_back(i % 10, i / 10 % 10, i / 100);
    geometry->positions[500].x = 1e30f;
    submesh.primitives.push_back({.mode = PrimitiveMode::Points, .geometry = geometry});
    SceneBuilder builder("made");
    builder.addNode("", kNone, glm::dmat4(1.0), builder.addSubmesh(submesh));
    const ScenePtr scene = builder.finish();
    EXPECT_EQ(worldBounds(*scene).max.x, static_cast<double>(1e30f));
    EXPECT_EQ(robustWorldBounds(*scene).max, glm::dvec3(9, 9, 9));
}

TEST(Lod, TheFullLodHasTheScenesOwnGeometryAndCounts) {
    SceneBuilder builder("made");
    const std::uint32_t submesh = builder.addSubmesh(triangleSubmesh("a"));
    builder.addNode("", kNone, moved(1, 0, 0), submesh);
    builder.addNode("", kNone, moved(2, 0, 0), submesh);
    const ScenePtr scene = builder.finish();
    const Lod lod = fullLod(*scene);
    EXPECT_EQ(lod.submeshes[0].primitives[0], scene->submeshes[0].primitives[0].geometry);
    EXPECT_EQ(lod.triangles, 2u);
    const LodShape shape = shapeOf(*scene, lod);
    EXPECT_FALSE(shape.submeshes[0].changed);
    EXPECT_EQ(shape.submeshes[0].kept_instances, 2u);
    EXPECT_EQ(shape.submeshes[0].primitives[0].vertices, 3u);
}
