#include "scene/gltf/source_document.h"
#include "tests/scene/gltf_maker.h"

#include <chrono>
#include <limits>

using namespace lodestone;
using lodestone::tests::GltfMaker;
using lodestone::tests::TempFolder;
using nlohmann::json;

namespace {

using Indices = std::vector<std::uint32_t>;

const Geometry& geometryOf(const Scene& scene, std::size_t submesh = 0, std::size_t primitive = 0) {
    return *scene.submeshes.at(submesh).primitives.at(primitive).geometry;
}

std::vector<float> pointsOnLine(int count) {
    std::vector<float> positions;
    for (int i = 0; i < count; ++i)
        positions.insert(positions.end(), {static_cast<float>(i), static_cast<float>(i * i), 0.0f});
    return positions;
}

glm::dvec3 originOf(const Instance& instance) {
    return glm::dvec3(instance.transform[3]);
}

// A triangle drawn by instances of EXT_mesh_gpu_instancing with these attributes.
json instancedNode(std::size_t mesh, json attributes) {
    return {{"mesh", mesh},
            {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", std::move(attributes)}}}}}};
}

} // namespace

TEST(GltfImport, AMeshOfManyNodesIsOneSubmeshWithManyInstances) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    for (int i = 0; i < 5; ++i)
        maker.addNode({{"mesh", mesh}, {"translation", {i, 0, 0}}});
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->submeshes.size(), 1u);
    ASSERT_EQ(scene->instances.size(), 5u);
    for (std::uint32_t i = 0; i < 5; ++i) {
        EXPECT_EQ(scene->instances[i].node, i);
        EXPECT_EQ(originOf(scene->instances[i]), glm::dvec3(i, 0, 0));
    }
}

TEST(GltfImport, TheTransformIsTheProductFromTheRoot) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    const double half = std::sqrt(0.5);
    maker.addNode({{"scale", {2, 2, 2}}, {"children", {1}}});
    maker.addNode({{"rotation", {0, 0, half, half}}, {"children", {2}}}, false);
    maker.addNode({{"translation", {3, 0, 0}}, {"mesh", mesh}}, false);
    const ScenePtr scene = maker.scene();
    const glm::dvec3 origin = originOf(scene->instances.at(0));
    EXPECT_NEAR(origin.x, 0.0, 1e-12);
    EXPECT_NEAR(origin.y, 6.0, 1e-12);
    EXPECT_EQ(scene->nodes[2].parent, 1u);
    EXPECT_EQ(scene->nodes[1].parent, 0u);
}

TEST(GltfImport, InstancesAreSortedBySubmeshThenByNode) {
    GltfMaker maker;
    const std::size_t a = maker.addTriangle();
    const std::size_t b = maker.addTriangle();
    for (const std::size_t mesh : {b, a, b, a})
        maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    const std::vector<std::uint32_t> expected{1, 3, 0, 2};
    ASSERT_EQ(scene->instances.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(scene->instances[i].node, expected[i]);
}

TEST(GltfImport, AMirroredMatrixKeepsItsNegativeDeterminant) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addTriangle()}, {"scale", {-1, 1, 1}}});
    const ScenePtr scene = maker.scene();
    EXPECT_LT(glm::determinant(glm::dmat3(scene->instances.at(0).transform)), 0.0);
}

TEST(GltfImport, StripsBecomeTrianglesWithTheWindingOfTheFormat) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addMesh(pointsOnLine(5), {}, 5)}});
    EXPECT_EQ(geometryOf(*maker.scene()).indices, (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
}

TEST(GltfImport, DegenerateTrianglesThatJoinStripsAreDropped) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addMesh(pointsOnLine(6), {0, 1, 2, 2, 3, 3, 4, 5}, 5)}});
    EXPECT_EQ(geometryOf(*maker.scene()).indices, (Indices{0, 1, 2, 3, 5, 4}));
}

TEST(GltfImport, FansBecomeTriangles) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addMesh(pointsOnLine(4), {}, 6)}});
    EXPECT_EQ(geometryOf(*maker.scene()).indices, (Indices{1, 2, 0, 2, 3, 0}));
}

TEST(GltfImport, PointsAndLinesKeepTheirMode) {
    GltfMaker maker;
    for (int mode = 0; mode < 4; ++mode)
        maker.addNode({{"mesh", maker.addMesh(pointsOnLine(4), {}, mode)}});
    const ScenePtr scene = maker.scene();
    for (std::size_t m = 0; m < 4; ++m) {
        EXPECT_EQ(scene->submeshes[m].primitives[0].mode, static_cast<PrimitiveMode>(m));
        EXPECT_EQ(geometryOf(*scene, m).indices, (Indices{0, 1, 2, 3}));
    }
    EXPECT_EQ(countScene(*scene).triangles, 0u);
}

TEST(GltfImport, EveryIndexTypeIsRead) {
    GltfMaker maker;
    const std::size_t positions = maker.addAccessor(pointsOnLine(3), 5126, "VEC3");
    const std::size_t accessors[] = {
        maker.addAccessor(std::vector<std::uint8_t>{2, 1, 0}, 5121, "SCALAR"),
        maker.addAccessor(std::vector<std::uint16_t>{2, 1, 0}, 5123, "SCALAR"),
        maker.addAccessor(std::vector<std::uint32_t>{2, 1, 0}, 5125, "SCALAR")};
    for (const std::size_t indices : accessors) {
        maker.json["meshes"].push_back(
            {{"primitives", {{{"attributes", {{"POSITION", positions}}}, {"indices", indices}}}}});
        maker.addNode({{"mesh", maker.json["meshes"].size() - 1}});
    }
    const ScenePtr scene = maker.scene();
    for (std::size_t m = 0; m < 3; ++m)
        EXPECT_EQ(geometryOf(*scene, m).indices, (Indices{2, 1, 0}));
}

TEST(GltfImport, InterleavedAttributesAreUnpacked) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    // Position and normal in turn, 24 bytes apart.
    const std::size_t view =
        maker.addView<float>({0, 0, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0, 1, 0, 1, 0, 0});
    maker.json["bufferViews"][view]["byteStride"] = 24;
    for (const int offset : {0, 12})
        maker.json["accessors"].push_back({{"bufferView", view},
                                           {"byteOffset", offset},
                                           {"componentType", 5126},
                                           {"count", 3},
                                           {"type", "VEC3"}});
    const std::size_t last = maker.json["accessors"].size() - 1;
    maker.json["meshes"][mesh]["primitives"][0]["attributes"] = {{"POSITION", last - 1},
                                                                 {"NORMAL", last}};
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(geometryOf(*scene).positions[2], glm::vec3(0, 1, 0));
    const Attribute* normal = findAttribute(geometryOf(*scene).attributes, "NORMAL");
    ASSERT_NE(normal, nullptr);
    EXPECT_EQ(attributeValue(*normal, 0, 2), 1.0f);
    EXPECT_EQ(attributeValue(*normal, 1, 1), 1.0f);
    EXPECT_EQ(attributeValue(*normal, 2, 0), 1.0f);
}

TEST(GltfImport, SparseValuesReplaceThoseOfTheBaseOrZeros) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    const json sparse{
        {"count", 1},
        {"indices", {{"bufferView", maker.addView<std::uint8_t>({1})}, {"componentType", 5121}}},
        {"values", {{"bufferView", maker.addView<float>({7, 8, 9})}}}};
    maker.json["accessors"][0]["sparse"] = sparse;
    maker.json["accessors"].push_back(
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
    maker.json["meshes"][mesh]["primitives"][0]["attributes"]["_SHIFT"] =
        maker.json["accessors"].size() - 1;
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(geometryOf(*scene).positions[1], glm::vec3(7, 8, 9));
    EXPECT_EQ(geometryOf(*scene).positions[2], glm::vec3(0, 1, 0));
    const Attribute* shift = findAttribute(geometryOf(*scene).attributes, "_SHIFT");
    ASSERT_NE(shift, nullptr);
    EXPECT_EQ(attributeValue(*shift, 0, 0), 0.0f);
    EXPECT_EQ(attributeValue(*shift, 1, 2), 9.0f);
}

TEST(GltfImport, QuantizedPositionsAreDecodedAndTheirTypeRemembered) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    const std::size_t view =
        maker.addView<std::int16_t>({32767, 0, 0, 0, -32767, 0, 0, 0, 0, 16384, 0, 0});
    maker.json["bufferViews"][view]["byteStride"] = 8;
    maker.json["accessors"][0] = {{"bufferView", view},
                                  {"componentType", 5122},
                                  {"normalized", true},
                                  {"count", 3},
                                  {"type", "VEC3"}};
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    const Primitive& primitive = scene->submeshes[0].primitives[0];
    EXPECT_EQ(primitive.position_type, ComponentType::Int16);
    EXPECT_TRUE(primitive.position_normalized);
    EXPECT_EQ(primitive.geometry->positions[0].x, 1.0f);
    EXPECT_EQ(primitive.geometry->positions[1].x, -1.0f);
    EXPECT_NEAR(primitive.geometry->positions[2].y, 16384.0f / 32767.0f, 1e-7f);
}

TEST(GltfImport, APrimitiveKeepsOnlyItsOwnVerticesOfASharedList) {
    GltfMaker maker;
    const std::size_t mesh = maker.addMesh(pointsOnLine(6), {3, 4, 5});
    const std::size_t other =
        maker.addAccessor(std::vector<std::uint16_t>{0, 1, 2}, 5123, "SCALAR");
    json primitive = maker.json["meshes"][mesh]["primitives"][0];
    primitive["indices"] = other;
    maker.json["meshes"][mesh]["primitives"].push_back(primitive);
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(geometryOf(*scene, 0, 0).positions.size(), 3u);
    EXPECT_EQ(geometryOf(*scene, 0, 0).positions[0].x, 3.0f);
    EXPECT_EQ(geometryOf(*scene, 0, 0).indices, (Indices{0, 1, 2}));
    EXPECT_EQ(geometryOf(*scene, 0, 1).positions.size(), 3u);
}

TEST(GltfImport, PrimitivesOfTheSameAccessorsShareTheirGeometry) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.json["meshes"].push_back(maker.json["meshes"][mesh]);
    maker.addNode({{"mesh", 0}});
    maker.addNode({{"mesh", 1}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(scene->submeshes[0].primitives[0].geometry,
              scene->submeshes[1].primitives[0].geometry);
}

TEST(GltfImport, GpuInstancesAreUnfoldedBelowTheirNode) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    const std::size_t translation = maker.addAccessor<float>({1, 0, 0, 2, 0, 0}, 5126, "VEC3");
    const std::size_t scale = maker.addAccessor<float>({1, 1, 1, 3, 3, 3}, 5126, "VEC3");
    // A quarter turn about z, as signed bytes.
    const std::size_t rotation =
        maker.addAccessor<std::int8_t>({0, 0, 90, 90, 0, 0, 90, 90}, 5120, "VEC4");
    maker.json["accessors"][rotation]["normalized"] = true;
    json node = instancedNode(
        mesh, {{"TRANSLATION", translation}, {"SCALE", scale}, {"ROTATION", rotation}});
    node["translation"] = {0, 10, 0};
    maker.addNode(node);
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->instances.size(), 2u);
    EXPECT_EQ(originOf(scene->instances[1]), glm::dvec3(2, 10, 0));
    EXPECT_EQ(scene->instances[1].gpu_index, 1u);
    const glm::dvec4 x = scene->instances[1].transform * glm::dvec4(1, 0, 0, 0);
    EXPECT_NEAR(x.y, 3.0, 1e-12);
    EXPECT_NEAR(x.x, 0.0, 1e-12);
    EXPECT_TRUE(scene->nodes[0].foldable);
}

TEST(GltfImport, DeepChainsAreReadWithoutRecursion) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    constexpr int kDepth = 30'000;
    json nodes = json::array();
    for (int i = 0; i < kDepth; ++i)
        nodes.push_back({{"translation", {0.5, 0, 0}}, {"children", {i + 1}}});
    nodes.push_back({{"mesh", mesh}});
    maker.json["nodes"] = std::move(nodes);
    maker.json["scenes"][0]["nodes"] = {0};
    EXPECT_EQ(originOf(maker.scene()->instances.at(0)), glm::dvec3(kDepth * 0.5, 0, 0));
}

TEST(GltfImport, ANodeWithTwoParentsIsDrawnBelowBothAndBecomesATree) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"translation", {1, 0, 0}}, {"children", {2}}});
    maker.addNode({{"translation", {2, 0, 0}}, {"children", {2}}});
    maker.addNode({{"mesh", mesh}}, false);
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->instances.size(), 2u);
    EXPECT_EQ(originOf(scene->instances[0]), glm::dvec3(1, 0, 0));
    EXPECT_EQ(originOf(scene->instances[1]), glm::dvec3(2, 0, 0));
    EXPECT_EQ(scene->source->json["nodes"][1]["children"], json({3}));
    EXPECT_EQ(scene->notes.size(), 1u);
}

TEST(GltfImport, AFileWithoutScenesShowsItsRootNodes) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"children", {1}}});
    maker.addNode({{"mesh", mesh}}, false);
    maker.json.erase("scene");
    maker.json.erase("scenes");
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(scene->instances.size(), 1u);
    EXPECT_EQ(scene->source->json["scenes"][0]["nodes"], json::array({0}));
}

TEST(GltfImport, AMeshThatNoNodeDrawsIsKeptButDoesNotCount) {
    GltfMaker maker;
    maker.addTriangle();
    const std::size_t drawn = maker.addTriangle();
    maker.addNode({{"mesh", drawn}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(scene->submeshes.size(), 2u);
    EXPECT_EQ(countScene(*scene).submeshes, 1u);
    EXPECT_EQ(countScene(*scene).unique_triangles, 1u);
}

TEST(GltfImport, APrimitiveWithoutPositionsIsDroppedFromSceneAndDocument) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    json& primitives = maker.json["meshes"][mesh]["primitives"];
    primitives.insert(primitives.begin(), json{{"attributes", json::object()}});
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(scene->submeshes[0].primitives.size(), 1u);
    EXPECT_EQ(scene->source->json["meshes"][0]["primitives"].size(), 1u);
    EXPECT_EQ(scene->notes.size(), 1u);
}

TEST(GltfImport, ADroppedMeshRenumbersTheNodesOfTheOthers) {
    GltfMaker maker;
    maker.json["meshes"].push_back({{"primitives", {{{"attributes", json::object()}}}}});
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"mesh", 0}});
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->submeshes.size(), 1u);
    EXPECT_FALSE(scene->source->json["nodes"][0].contains("mesh"));
    EXPECT_EQ(scene->source->json["nodes"][1]["mesh"], 0);
    EXPECT_EQ(scene->instances.at(0).node, 1u);
}

TEST(GltfImport, OnlyPlainLeavesAreFoldable) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"mesh", mesh}});
    maker.addNode({{"mesh", mesh}, {"extras", {{"id", 1}}}});
    maker.addNode({{"mesh", mesh}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    maker.addNode({{"mesh", mesh}, {"children", {4}}});
    maker.addNode({{"mesh", mesh}}, false);
    maker.addNode({{"mesh", mesh}});
    const std::size_t times = maker.addAccessor<float>({0, 1}, 5126, "SCALAR");
    const std::size_t values = maker.addAccessor<float>({0, 0, 0, 1, 1, 1}, 5126, "VEC3");
    maker.json["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 5}, {"path", "scale"}}}}}},
         {"samplers", {{{"input", times}, {"output", values}}}}}};
    const ScenePtr scene = maker.scene();
    const bool expected[] = {true, false, false, false, true, false};
    for (std::size_t n = 0; n < 6; ++n)
        EXPECT_EQ(scene->nodes[n].foldable, expected[n]) << n;
}

TEST(GltfImport, EverythingBelowAnAnimatedNodeIsAnimated) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"children", {1}}});
    maker.addNode({{"mesh", mesh}}, false);
    maker.addNode({{"mesh", mesh}});
    const std::size_t times = maker.addAccessor<float>({0, 1}, 5126, "SCALAR");
    const std::size_t values = maker.addAccessor<float>({0, 0, 0, 1, 1, 1}, 5126, "VEC3");
    maker.json["animations"] = {
        {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}},
         {"samplers", {{{"input", times}, {"output", values}}}}}};
    const ScenePtr scene = maker.scene();
    EXPECT_TRUE(scene->nodes[0].animated);
    EXPECT_TRUE(scene->nodes[1].animated);
    EXPECT_FALSE(scene->nodes[2].animated);
}

TEST(GltfImport, ACameraHasTheWorldTransformOfItsNode) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"mesh", mesh}});
    maker.addNode({{"translation", {0, 5, 0}}, {"children", {2}}});
    maker.addNode({{"translation", {0, 0, 7}}, {"camera", 0}}, false);
    maker.json["cameras"] = {{{"name", "eye"},
                              {"type", "perspective"},
                              {"perspective", {{"yfov", 0.7}, {"znear", 0.2}}}}};
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->cameras.size(), 1u);
    EXPECT_EQ(scene->nodes[2].camera, 0u);
    EXPECT_EQ(scene->cameras[0].name, "eye");
    EXPECT_EQ(glm::dvec3(scene->cameras[0].world[3]), glm::dvec3(0, 5, 7));
    EXPECT_EQ(scene->cameras[0].yfov_rad, 0.7);
    EXPECT_EQ(scene->cameras[0].zfar, 0.0);
}

TEST(GltfImport, MaterialsAreReadWithTheirTextures) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addTriangle()}});
    maker.json["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
    maker.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}}};
    maker.json["textures"] = {{{"sampler", 0}, {"source", 0}}};
    maker.json["materials"] = {
        {{"name", "bark"},
         {"alphaMode", "MASK"},
         {"alphaCutoff", 0.25},
         {"doubleSided", true},
         {"extensions", {{"KHR_materials_unlit", json::object()}}},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.5, 0.25, 0.125, 1}},
           {"metallicFactor", 0},
           {"baseColorTexture",
            {{"index", 0},
             {"texCoord", 1},
             {"extensions",
              {{"KHR_texture_transform", {{"offset", {0.5, 0.25}}, {"scale", {2, 3}}}}}}}}}}}};
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->materials.size(), 1u);
    const Material& material = scene->materials[0];
    EXPECT_EQ(material.name, "bark");
    EXPECT_EQ(material.base_color, glm::vec4(0.5f, 0.25f, 0.125f, 1.0f));
    EXPECT_EQ(material.metallic, 0.0f);
    EXPECT_EQ(material.alpha_mode, AlphaMode::Mask);
    EXPECT_EQ(material.alpha_cutoff, 0.25f);
    EXPECT_TRUE(material.double_sided);
    EXPECT_TRUE(material.unlit);
    const TextureRef& texture = material.base_color_texture;
    EXPECT_EQ(texture.image, 0u);
    EXPECT_EQ(texture.texcoord, 1u);
    EXPECT_EQ(texture.wrap_u, TextureWrap::ClampToEdge);
    EXPECT_EQ(texture.wrap_v, TextureWrap::MirroredRepeat);
    EXPECT_TRUE(texture.nearest);
    EXPECT_EQ(texture.uv_transform * glm::vec3(1, 1, 1), glm::vec3(2.5f, 3.25f, 1.0f));
    ASSERT_EQ(scene->images.size(), 1u);
    EXPECT_EQ(scene->images[0].mime_type, "image/png");
    EXPECT_EQ(scene->images[0].bytes->size(), 8u);
}

TEST(GltfImport, ATextureRotationTurnsTheImageClockwise) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addTriangle()}});
    maker.json["images"] = {{{"uri", "data:image/png;base64,iVBORw0KGgo="}}};
    maker.json["textures"] = {{{"source", 0}}};
    const double quarter = 1.5707963267948966;
    maker.json["materials"] = {
        {{"emissiveTexture",
          {{"index", 0}, {"extensions", {{"KHR_texture_transform", {{"rotation", quarter}}}}}}}}};
    const ScenePtr scene = maker.scene();
    const glm::vec3 uv =
        scene->materials[0].emissive_texture.uv_transform * glm::vec3(1.0f, 0.0f, 1.0f);
    EXPECT_NEAR(uv.x, 0.0f, 1e-6f); // v points down, so -v is up: u turned to the left
    EXPECT_NEAR(uv.y, -1.0f, 1e-6f);
}

TEST(GltfImport, NonFiniteNormalsAreReplacedByThoseOfTheSurface) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    maker.json["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] =
        maker.addAccessor<float>({nan, 0, 0, 0, 0, 0, 1, 0, 0}, 5126, "VEC3");
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    const Attribute& normal = geometryOf(*scene).attributes.at(0);
    EXPECT_EQ(attributeValue(normal, 0, 0), 0.0f);
    EXPECT_EQ(attributeValue(normal, 0, 2), 1.0f);
    EXPECT_EQ(attributeValue(normal, 1, 2), 0.0f); // a zero-length normal stays
    EXPECT_EQ(attributeValue(normal, 2, 0), 1.0f);
    EXPECT_EQ(scene->notes.size(), 1u);
}

TEST(GltfImport, MorphTargetsAndSkinsAreKept) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.json["meshes"][mesh]["primitives"][0]["targets"] = {
        {{"POSITION", maker.addAccessor<float>({0, 0, 1, 0, 0, 2, 0, 0, 3}, 5126, "VEC3")}}};
    maker.addNode({{"mesh", mesh}, {"skin", 0}});
    maker.addNode(json::object());
    maker.json["skins"] = {{{"joints", {1}}}};
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(geometryOf(*scene).morph_targets.size(), 1u);
    EXPECT_EQ(attributeValue(geometryOf(*scene).morph_targets[0].attributes.at(0), 2, 2), 3.0f);
    EXPECT_EQ(scene->nodes[0].skin, 0u);
    EXPECT_FALSE(scene->nodes[0].foldable);
}

TEST(GltfImport, ExternalFilesAndPercentEncodedNamesAreRead) {
    const TempFolder folder;
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addTriangle()}});
    maker.json["images"] = {{{"uri", "pictures/missing.png"}}};
    maker.json["buffers"] = {{{"byteLength", maker.buffer.size()}, {"uri", "my%20data.bin"}}};
    folder.write("my data.bin", maker.buffer + "more");
    const Result<ScenePtr> scene = importScene(folder.write("a.gltf", maker.json.dump()), {});
    ASSERT_TRUE(scene) << scene.error().message;
    EXPECT_EQ(countScene(**scene).triangles, 1u);
    EXPECT_EQ((*scene)->file_bytes, maker.json.dump().size() + maker.buffer.size() + 4);
    EXPECT_EQ((*scene)->images.at(0).bytes, nullptr);
    EXPECT_EQ((*scene)->notes.size(), 1u);
}

TEST(GltfImport, AFarOutlierLoadsAndIsNamed) {
    GltfMaker maker;
    std::vector<float> positions;
    std::vector<std::uint16_t> indices;
    for (int i = 0; i < 300; ++i) {
        const auto x = static_cast<float>(i % 20);
        const auto y = static_cast<float>(i / 20);
        positions.insert(positions.end(), {x, y, 0.0f});
        indices.push_back(static_cast<std::uint16_t>(i));
    }
    positions[3 * 7] = 1e30f;
    maker.addNode({{"mesh", maker.addMesh(positions, indices)}});
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->notes.size(), 1u);
    EXPECT_NE(scene->notes[0].find("vertex 7"), std::string::npos) << scene->notes[0];
}

TEST(GltfImport, ARequiredUnknownExtensionIsNotedAndKept) {
    GltfMaker maker;
    maker.addNode({{"mesh", maker.addTriangle()}});
    maker.json["extensionsRequired"] = {"ACME_fur"};
    const ScenePtr scene = maker.scene();
    ASSERT_EQ(scene->notes.size(), 1u);
    EXPECT_NE(scene->notes[0].find("ACME_fur"), std::string::npos);
    EXPECT_EQ(scene->source->json["extensionsRequired"][0], "ACME_fur");
}

TEST(GltfImport, UncompressedDataBesideACompressedTwinAreRead) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.json["meshes"][mesh]["primitives"][0]["extensions"] = {
        {"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}}}}}};
    maker.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    EXPECT_EQ(countScene(*scene).triangles, 1u);
    EXPECT_FALSE(scene->source->json.contains("extensionsUsed"));
    EXPECT_TRUE(scene->notes.empty());
}

TEST(GltfImport, NormalsFarFromUnitLengthAreMadeUnitAndNoted) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    const std::vector<float> normals{0, 0, 0.0625f, 0, 0, 1, 0, 0, 0};
    maker.json["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] =
        maker.addAccessor(normals, 5126, "VEC3");
    maker.addNode({{"mesh", mesh}});
    const ScenePtr scene = maker.scene();
    const Attribute& read = scene->submeshes[0].primitives[0].geometry->attributes[0];
    EXPECT_FLOAT_EQ(attributeValue(read, 0, 2), 1.0f);
    EXPECT_FLOAT_EQ(attributeValue(read, 1, 2), 1.0f);
    EXPECT_FLOAT_EQ(attributeValue(read, 2, 2), 0.0f); // has no direction to keep
    ASSERT_EQ(scene->notes.size(), 1u);
    EXPECT_NE(scene->notes[0].find("1 normals were not of unit length"), std::string::npos);
}
