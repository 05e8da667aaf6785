// Exports that are quantised, or packed by meshopt or Draco, and back.
#include "scene/export.h"
#include "scene/gltf/source_document.h"
#include "scene/import.h"
#include "scene/scene_builder.h"
#include "tests/scene/scene_fixtures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <set>
#include <unistd.h>

namespace lodestone {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr std::array kCompressions{Compression::Quantize, Compression::Meshopt, Compression::Draco};

std::vector<char> contentsOf(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

json documentOf(const fs::path& glb) {
    const std::vector<char> bytes = contentsOf(glb);
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, sizeof length);
    return json::parse(bytes.begin() + 20, bytes.begin() + 20 + length);
}

std::vector<glm::dvec3> worldVertices(const Scene& scene) {
    std::vector<glm::dvec3> vertices;
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.submeshes[instance.submesh].primitives)
            for (const glm::vec3& position : primitive.geometry->positions)
                vertices.emplace_back(instance.transform * glm::dvec4(glm::dvec3(position), 1.0));
    return vertices;
}

// From each vertex of `from` to the nearest of `to`, the greatest.
double greatestGap(const Scene& from, const Scene& to) {
    const std::vector<glm::dvec3> targets = worldVertices(to);
    double greatest = 0.0;
    for (const glm::dvec3& vertex : worldVertices(from)) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& target : targets)
            nearest = std::min(nearest, glm::distance(vertex, target));
        greatest = std::max(greatest, nearest);
    }
    return greatest;
}

// Cubes turned, scaled and scattered by fixed numbers.
ScenePtr scatteredCubes(std::uint32_t count) {
    std::vector<glm::dmat4> transforms;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto k = static_cast<double>(i);
        const glm::dvec3 at(
            std::fmod(k * 7.31, 40.0), std::fmod(k * 3.17, 9.0), std::fmod(k * 11.9, 40.0));
        const glm::dmat4 turned =
            glm::rotate(glm::translate(glm::dmat4(1.0), at), k * 0.7, glm::dvec3(0.6, 0.48, 0.64));
        transforms.push_back(glm::scale(turned, glm::dvec3(0.5 + 0.01 * k)));
    }
    return fixtures::sceneOf(fixtures::cubeGeometry(), transforms);
}

class CompressedExport : public ::testing::Test {
protected:
    void SetUp() override { fs::create_directories(folder_); }

    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const Scene& scene, const ExportOptions& options, const char* name) {
        fs::path path = folder_ / name;
        const auto report = exportScene(scene, fullLod(scene), path, options);
        EXPECT_TRUE(report) << report.error().message;
        EXPECT_EQ(report ? report->bytes : 0, fs::file_size(path));
        return path;
    }

    ScenePtr sent(const Scene& scene, const ExportOptions& options) {
        auto again = importScene(write(scene, options, "scene.glb"), {});
        EXPECT_TRUE(again) << again.error().message;
        return again ? *again : nullptr;
    }

    fs::path folder_ =
        fs::temp_directory_path() / ("lodestone_compressed_" + std::to_string(::getpid()));
};

TEST_F(CompressedExport, EveryVertexOfEveryInstanceComesBackWhereItWas) {
    for (const ScenePtr& scene : {fixtures::twoMaterialCubeScene(),
                                  fixtures::awkwardInstancesScene(),
                                  fixtures::texturedQuadScene(),
                                  fixtures::gridScene(9),
                                  fixtures::cubeRowScene(12),
                                  scatteredCubes(40)})
        for (const Compression compression : kCompressions)
            for (const Instancing instancing :
                 {Instancing::Auto, Instancing::Nodes, Instancing::Gpu, Instancing::Expand}) {
                SCOPED_TRACE(scene->name + ", compression " +
                             std::to_string(static_cast<int>(compression)) + ", instancing " +
                             std::to_string(static_cast<int>(instancing)));
                const ScenePtr again = sent(*scene, {instancing, Container::Glb, compression});
                ASSERT_TRUE(again);
                EXPECT_EQ(countScene(*again).triangles, countScene(*scene).triangles);
                const double allowed = 3e-4 * worldBounds(*scene).diagonal();
                EXPECT_LE(greatestGap(*scene, *again), allowed);
                EXPECT_LE(greatestGap(*again, *scene), allowed);
            }
}

TEST_F(CompressedExport, TheSameSceneGivesTheSameBytes) {
    const ScenePtr scene = scatteredCubes(30);
    for (const Compression compression : kCompressions) {
        const ExportOptions options{Instancing::Gpu, Container::Glb, compression};
        EXPECT_EQ(contentsOf(write(*scene, options, "a.glb")),
                  contentsOf(write(*scene, options, "b.glb")));
    }
}

TEST_F(CompressedExport, MeshoptViewsFollowTheRulesOfTheFallbackBuffer) {
    const ScenePtr scene = scatteredCubes(30);
    const json document = documentOf(
        write(*scene, {Instancing::Gpu, Container::Glb, Compression::Meshopt}, "scene.glb"));
    constexpr const char* kName = "EXT_meshopt_compression";
    for (const char* list : {"extensionsUsed", "extensionsRequired"})
        EXPECT_NE(std::ranges::find(document[list], json(kName)), document[list].end()) << list;
    ASSERT_EQ(document["buffers"].size(), 2U);
    EXPECT_FALSE(document["buffers"][1].contains("uri"));
    EXPECT_EQ(document["buffers"][1]["extensions"][kName]["fallback"], true);
    std::set<std::string> filters;
    for (const json& view : document["bufferViews"]) {
        const json& words = view["extensions"][kName];
        EXPECT_EQ(view["buffer"], 1);
        EXPECT_EQ(words["buffer"], 0);
        EXPECT_EQ(view["byteLength"].get<int>(),
                  words["count"].get<int>() * words["byteStride"].get<int>());
        EXPECT_LE(view["byteOffset"].get<int>() + view["byteLength"].get<int>(),
                  document["buffers"][1]["byteLength"].get<int>());
        EXPECT_LE(words["byteOffset"].get<int>() + words["byteLength"].get<int>(),
                  document["buffers"][0]["byteLength"].get<int>());
        filters.insert(words.value("filter", "NONE"));
    }
    EXPECT_EQ(filters, (std::set<std::string>{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"}));
}

TEST_F(CompressedExport, PackedIsSmallerThanQuantisedIsSmallerThanRaw) {
    const ScenePtr scene = fixtures::gridScene(60);
    const auto bytes = [&](Compression compression) {
        return fs::file_size(
            write(*scene, {Instancing::Auto, Container::Glb, compression}, "scene.glb"));
    };
    EXPECT_LT(bytes(Compression::Quantize), bytes(Compression::None));
    EXPECT_LT(bytes(Compression::Meshopt), bytes(Compression::Quantize) / 2);
    EXPECT_LT(bytes(Compression::Draco), bytes(Compression::Quantize) / 2);
}

TEST_F(CompressedExport, QuantisedSizesArePredictedToTheByteAndPackedOnesNearly) {
    for (const ScenePtr& scene : {scatteredCubes(200), fixtures::gridScene(40)})
        for (const Instancing instancing : {Instancing::Auto, Instancing::Expand}) {
            const ExportOptions quantize{instancing, Container::Glb, Compression::Quantize};
            const LodShape shape = shapeOf(*scene, fullLod(*scene));
            EXPECT_EQ(ByteModel(scene, quantize).bytes(shape),
                      fs::file_size(write(*scene, quantize, "scene.glb")));
            for (const Compression compression : {Compression::Meshopt, Compression::Draco}) {
                const ExportOptions packed{instancing, Container::Glb, compression};
                const auto size =
                    static_cast<double>(fs::file_size(write(*scene, packed, "scene.glb")));
                EXPECT_NEAR(
                    static_cast<double>(ByteModel(scene, packed).bytes(shape)), size, 0.1 * size);
            }
        }
}

// Component type of the only ROTATION of the scene's rows.
int rotationType(const json& document) {
    for (const json& node : document["nodes"])
        if (node.contains("extensions")) {
            const json& rows = node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
            return document["accessors"][rows["ROTATION"].get<std::size_t>()]["componentType"];
        }
    return 0;
}

TEST_F(CompressedExport, RotationsOfRowsHave16BitsUnlessThatMovesFarPoints) {
    const ExportOptions raw{Instancing::Gpu, Container::Glb, Compression::None};
    const ScenePtr near = scatteredCubes(40);
    EXPECT_EQ(rotationType(documentOf(write(*near, raw, "near.glb"))), 5122);
    const ScenePtr again = sent(*near, raw);
    ASSERT_TRUE(again);
    EXPECT_LE(greatestGap(*near, *again), 4e-6 * worldBounds(*near).diagonal());
    // Beams as long as the scene: half the scene's size away from what they turn about.
    std::vector<glm::dmat4> transforms;
    for (int i = 0; i < 40; ++i)
        transforms.push_back(glm::scale(
            glm::rotate(glm::dmat4(1.0), 0.37 * i, glm::dvec3(0.6, 0.48, 0.64)), glm::dvec3(20.0)));
    const ScenePtr far = fixtures::sceneOf(fixtures::cubeGeometry(), transforms);
    EXPECT_EQ(rotationType(documentOf(write(*far, raw, "far.glb"))), 5126);
}

// The cubes with that many of their twelve triangles.
Lod withTriangles(const Scene& scene, std::size_t triangles) {
    Lod lod = fullLod(scene);
    for (LodSubmesh& submesh : lod.submeshes) {
        auto geometry = std::make_shared<Geometry>(*submesh.primitives[0]);
        geometry->indices.resize(3 * triangles);
        submesh.primitives[0] = std::move(geometry);
    }
    return lod;
}

TEST_F(CompressedExport, RotationsOfRowsHave8BitsOnceAThirdOfTheirSubmeshIsLeft) {
    const ScenePtr scene = scatteredCubes(40);
    for (const Compression compression : {Compression::None, Compression::Quantize})
        for (const auto& [triangles, type] : {std::pair{5, 5122}, {4, 5120}}) {
            const ExportOptions options{Instancing::Gpu, Container::Glb, compression};
            const Lod lod = withTriangles(*scene, static_cast<std::size_t>(triangles));
            const fs::path path = folder_ / "coarse.glb";
            ASSERT_TRUE(exportScene(*scene, lod, path, options));
            EXPECT_EQ(rotationType(documentOf(path)), type);
            EXPECT_EQ(ByteModel(scene, options).bytes(shapeOf(*scene, lod)), fs::file_size(path));
            const auto again = importScene(path, {});
            ASSERT_TRUE(again);
            EXPECT_LE(greatestGap(**again, *scene), 0x1p-10 * worldBounds(*scene).diagonal());
        }
}

TEST_F(CompressedExport, CoarseRotationsLeaveTheMiddleOfAMeshWhereItIs) {
    const ScenePtr cubes = scatteredCubes(40);
    std::vector<glm::dmat4> transforms;
    for (const Instance& instance : cubes->instances)
        transforms.push_back(instance.transform);
    Geometry off = *fixtures::cubeGeometry(); // off the origin that they turn about
    for (glm::vec3& position : off.positions)
        position += glm::vec3(2.0f, 0.0f, 0.0f);
    const ScenePtr scene =
        fixtures::sceneOf(std::make_shared<const Geometry>(std::move(off)), transforms);
    const fs::path path = folder_ / "off.glb";
    ASSERT_TRUE(
        exportScene(*scene, withTriangles(*scene, 4), path, {Instancing::Gpu, Container::Glb, {}}));
    EXPECT_EQ(rotationType(documentOf(path)), 5120);
    const auto again = importScene(path, {});
    ASSERT_TRUE(again);
    const glm::dvec4 middle(localBounds(scene->submeshes[0]).center(), 1.0);
    for (const Instance& instance : scene->instances) {
        double nearest = std::numeric_limits<double>::infinity();
        for (const Instance& other : (*again)->instances)
            nearest = std::min(
                nearest, glm::distance(instance.transform * middle, other.transform * middle));
        EXPECT_LE(nearest, 1e-6 * worldBounds(*scene).diagonal());
    }
}

TEST_F(CompressedExport, NodesWithADutyOfTheirOwnKeepTheirTransform) {
    SceneBuilder builder("duty");
    Submesh submesh;
    submesh.primitives.push_back({});
    submesh.primitives[0].geometry = fixtures::cubeGeometry();
    const std::uint32_t cube = builder.addSubmesh(std::move(submesh));
    const std::uint32_t parent = builder.addNode(
        "parent", kNone, glm::translate(glm::dmat4(1.0), glm::dvec3(1.0, 2.0, 3.0)), cube);
    builder.addNode("child", parent, glm::translate(glm::dmat4(1.0), glm::dvec3(5.0)), cube);
    const ScenePtr scene = builder.finish();
    const ScenePtr again = sent(*scene, {Instancing::Nodes, Container::Glb, Compression::Quantize});
    ASSERT_TRUE(again);
    const auto named = std::ranges::find(again->nodes, "parent", &Node::name);
    ASSERT_NE(named, again->nodes.end());
    EXPECT_EQ(named->world, scene->nodes[parent].world);
    EXPECT_LE(greatestGap(*scene, *again), 1e-4);
}

TEST_F(CompressedExport, DracoSaysWhichTrianglesItCannotHold) {
    GeometryPtr grid = fixtures::gridGeometry(8);
    Geometry geometry = *grid;
    geometry.indices.insert(geometry.indices.end(), {3, 3, 4});
    const ScenePtr scene = fixtures::sceneOf(std::make_shared<const Geometry>(geometry));
    const auto report = exportScene(*scene,
                                    fullLod(*scene),
                                    folder_ / "scene.glb",
                                    {Instancing::Auto, Container::Glb, Compression::Draco});
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_TRUE(std::ranges::any_of(report->notes, [](const std::string& note) {
        return note.starts_with("1 triangles with two equal corners");
    }));
}

} // namespace
} // namespace lodestone
