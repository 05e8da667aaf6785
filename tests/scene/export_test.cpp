#include "scene/expand.h"
#include "scene/export.h"
#include "scene/import.h"
#include "tests/scene/scene_fixtures.h"

#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/resource.h>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

class ExportTest : public ::testing::Test {
protected:
    void SetUp() override {
        const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = fs::temp_directory_path() / (std::string("lodestone_export_") + test->name());
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }

    void TearDown() override { fs::remove_all(folder_); }

    std::uint64_t folderBytes() const {
        std::uint64_t bytes = 0;
        for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_))
            bytes += entry.is_regular_file() ? entry.file_size() : 0;
        return bytes;
    }

    fs::path folder_;
};

std::vector<ScenePtr> everyFixture() {
    return {fixtures::triangleScene(),
            fixtures::twoMaterialCubeScene(),
            fixtures::awkwardInstancesScene(),
            fixtures::texturedQuadScene(),
            fixtures::cubeRowScene(50),
            fixtures::gridScene(20)};
}

constexpr std::array kEveryInstancing{
    Instancing::Auto, Instancing::Nodes, Instancing::Gpu, Instancing::Expand};

TEST_F(ExportTest, EveryFixtureComesBackWithItsTrianglesAndBounds) {
    for (const ScenePtr& scene : everyFixture())
        for (const Instancing instancing : kEveryInstancing)
            for (const char* name : {"scene.glb", "scene.gltf"}) {
                const fs::path path = folder_ / name;
                const auto report = exportScene(*scene, fullLod(*scene), path, {instancing});
                ASSERT_TRUE(report) << report.error().message;
                const auto again = importScene(path, {});
                ASSERT_TRUE(again) << again.error().message;
                EXPECT_EQ(countScene(**again).triangles, countScene(*scene).triangles);
                const Bounds before = worldBounds(*scene);
                const Bounds after = worldBounds(**again);
                EXPECT_LE(glm::length(before.min - after.min), 1e-5 * before.diagonal());
                EXPECT_LE(glm::length(before.max - after.max), 1e-5 * before.diagonal());
            }
}

TEST_F(ExportTest, GpuRowsAreUsedWhereTheyAreSmaller) {
    const ScenePtr many = fixtures::cubeRowScene(50);
    const ScenePtr one = fixtures::cubeScene();
    const auto of_many = exportScene(*many, fullLod(*many), folder_ / "many.glb", {});
    const auto of_one = exportScene(*one, fullLod(*one), folder_ / "one.glb", {});
    ASSERT_TRUE(of_many && of_one);
    EXPECT_EQ(of_many->submeshes_as_gpu_instances, 1U);
    EXPECT_EQ(of_one->submeshes_as_gpu_instances, 0U);
    ASSERT_EQ(of_many->notes.size(), 1U);
    EXPECT_NE(of_many->notes[0].find("50"), std::string::npos) << "names dropped are counted";
}

TEST_F(ExportTest, RemovedInstancesAreGone) {
    const ScenePtr scene = fixtures::cubeRowScene(20);
    Lod lod = fullLod(*scene);
    lod.submeshes[0].instance_order =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{
            7, 3, 12, 0, 1, 2, 4, 5, 6, 8, 9, 10, 11, 13, 14, 15, 16, 17, 18, 19});
    lod.submeshes[0].kept_instances = 3;
    for (const Instancing instancing : kEveryInstancing) {
        ASSERT_TRUE(exportScene(*scene, lod, folder_ / "few.glb", {instancing}));
        const auto again = importScene(folder_ / "few.glb", {});
        ASSERT_TRUE(again) << again.error().message;
        EXPECT_EQ(countScene(**again).triangles, 3U * 12U);
        const Bounds bounds = worldBounds(**again);
        EXPECT_NEAR(bounds.min.x, 2.0 * 3 - 0.5, 1e-5);
        EXPECT_NEAR(bounds.max.x, 2.0 * 12 + 0.5, 1e-5);
    }
}

TEST_F(ExportTest, ImageBytesAreUntouched) {
    const ScenePtr scene = fixtures::texturedQuadScene();
    for (const char* name : {"quad.glb", "quad.gltf"}) {
        ASSERT_TRUE(exportScene(*scene, fullLod(*scene), folder_ / name, {}));
        const auto again = importScene(folder_ / name, {});
        ASSERT_TRUE(again) << again.error().message;
        ASSERT_EQ((*again)->images.size(), 1U);
        EXPECT_EQ(*(*again)->images[0].bytes, *scene->images[0].bytes);
        EXPECT_EQ((*again)->materials[0].name, "textured");
    }
}

TEST_F(ExportTest, SameInputGivesTheSameBytes) {
    const ScenePtr scene = fixtures::awkwardInstancesScene();
    const auto read = [&](const char* name) {
        EXPECT_TRUE(exportScene(*scene, fullLod(*scene), folder_ / name, {}));
        std::ifstream file(folder_ / name, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(file), {});
    };
    EXPECT_EQ(read("a.glb"), read("b.glb"));
}

TEST_F(ExportTest, AFailureNamesTheFileAndLeavesNothingBehind) {
    const ScenePtr scene = fixtures::cubeScene();
    const auto missing = exportScene(*scene, fullLod(*scene), folder_ / "nowhere" / "cube.glb", {});
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().kind, ErrorKind::Failed);
    EXPECT_NE(missing.error().message.find("nowhere"), std::string::npos);
    fs::create_directory(folder_ / "taken.glb");
    EXPECT_FALSE(exportScene(*scene, fullLod(*scene), folder_ / "taken.glb", {}));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "no temporary file is left";
}

// A triangle with skinning weights of which only the last vertex adds up.
ScenePtr weightedTriangle(ComponentType type) {
    auto scene = std::make_shared<Scene>(*fixtures::triangleScene());
    Geometry geometry = *scene->submeshes[0].primitives[0].geometry;
    Attribute weights{"WEIGHTS_0", type, 4, type != ComponentType::Float32, {}};
    weights.bytes.resize(3 * weights.stride());
    const std::array<std::array<float, 4>, 3> values{
        {{0.2f, 0.2f, 0.2f, 0.0f}, {0.1f, 0.0f, 0.0f, 0.0f}, {0.4f, 0.6f, 0.0f, 0.0f}}};
    for (std::size_t v = 0; v < 3; ++v)
        for (std::size_t c = 0; c < 4; ++c)
            setAttributeValue(weights, v, c, values[v][c]);
    geometry.attributes.push_back(std::move(weights));
    scene->submeshes[0].primitives[0].geometry = std::make_shared<const Geometry>(geometry);
    return scene;
}

TEST_F(ExportTest, WeightsOfSimplifiedMeshesAddUpAndOthersAreUntouched) {
    const fs::path path = folder_ / "weights.glb";
    const auto weightsOf = [&](const Scene& scene, const Lod& lod) {
        EXPECT_TRUE(exportScene(scene, lod, path, {}));
        const auto again = importScene(path, {});
        EXPECT_TRUE(again);
        return *findAttribute((*again)->submeshes[0].primitives[0].geometry->attributes,
                              "WEIGHTS_0");
    };
    for (const ComponentType type :
         {ComponentType::Float32, ComponentType::UInt8, ComponentType::UInt16}) {
        const ScenePtr scene = weightedTriangle(type);
        const GeometryPtr own = scene->submeshes[0].primitives[0].geometry;
        Lod lod = fullLod(*scene);
        EXPECT_EQ(weightsOf(*scene, lod).bytes, findAttribute(own->attributes, "WEIGHTS_0")->bytes);
        lod.submeshes[0].primitives[0] = std::make_shared<const Geometry>(*own);
        const Attribute weights = weightsOf(*scene, lod);
        for (std::size_t v = 0; v < 3; ++v) {
            float sum = 0.0f;
            for (std::size_t c = 0; c < 4; ++c)
                sum += attributeValue(weights, v, c);
            EXPECT_NEAR(sum, 1.0f, 1e-6f) << "vertex " << v;
        }
        EXPECT_NEAR(attributeValue(weights, 2, 0), 0.4f, 0.5f / 255.0f);
    }
}

// Writing past 4 KiB of any file fails, as on a full disk, for as long as this lives.
class FullDisk {
public:
    FullDisk() {
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
        getrlimit(RLIMIT_FSIZE, &before_);
        rlimit limit = before_;
        limit.rlim_cur = 4096;
        setrlimit(RLIMIT_FSIZE, &limit);
    }

    FullDisk(const FullDisk&) = delete;
    FullDisk& operator=(const FullDisk&) = delete;

    ~FullDisk() {
        setrlimit(RLIMIT_FSIZE, &before_);
        (void)std::signal(SIGXFSZ, handler_);
    }

private:
    rlimit before_{};
    void (*handler_)(int) = SIG_DFL;
};

TEST_F(ExportTest, AFullDiskLeavesTheOldFilesIntactAndNothingElse) {
    const ScenePtr small = fixtures::cubeScene();
    const ScenePtr large = fixtures::gridScene(40);
    for (const char* name : {"old.glb", "old.gltf"}) {
        const fs::path path = folder_ / name;
        ASSERT_TRUE(exportScene(*small, fullLod(*small), path, {}));
        const std::uint64_t bytes_before = folderBytes();
        const auto files_before = std::distance(fs::directory_iterator(folder_), {});
        const auto report = [&] {
            const FullDisk full;
            return exportScene(*large, fullLod(*large), path, {});
        }();
        ASSERT_FALSE(report) << name;
        EXPECT_EQ(report.error().kind, ErrorKind::Failed);
        EXPECT_NE(report.error().message.find("old"), std::string::npos);
        EXPECT_NE(report.error().message.find("free some space"), std::string::npos);
        EXPECT_EQ(folderBytes(), bytes_before);
        EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), files_before);
        const auto again = importScene(path, {});
        ASSERT_TRUE(again) << again.error().message;
        EXPECT_EQ(countScene(**again).triangles, countScene(*small).triangles);
    }
}

TEST_F(ExportTest, ACancelledExportLeavesTheOldFilesAndNothingElse) {
    const ScenePtr small = fixtures::cubeScene();
    const ScenePtr large = fixtures::gridScene(40);
    std::stop_source stopped;
    stopped.request_stop();
    for (const char* name : {"old.glb", "old.gltf"}) {
        const fs::path path = folder_ / name;
        ASSERT_TRUE(exportScene(*small, fullLod(*small), path, {}));
        const std::uint64_t bytes_before = folderBytes();
        for (const Compression compression : {Compression::None, Compression::Meshopt})
            for (const ExportGate& gate :
                 {ExportGate{stopped.get_token(), {}}, ExportGate{{}, [] { return false; }}}) {
                const ExportOptions options{Instancing::Auto, Container::Glb, compression};
                const auto report = exportScene(*large, fullLod(*large), path, options, gate);
                ASSERT_FALSE(report) << name;
                EXPECT_EQ(report.error().kind, ErrorKind::Cancelled);
                EXPECT_EQ(folderBytes(), bytes_before) << name;
            }
    }
}

TEST_F(ExportTest, TheGateIsAskedOnceAndBeforeAnyFileAppears) {
    const ScenePtr scene = fixtures::cubeScene();
    for (const char* name : {"new.glb", "new.gltf"}) {
        int asked = 0;
        const ExportGate gate{{}, [&] {
                                  ++asked;
                                  EXPECT_FALSE(fs::exists(folder_ / name));
                                  EXPECT_FALSE(fs::exists(folder_ / "new.bin"));
                                  return true;
                              }};
        ASSERT_TRUE(exportScene(*scene, fullLod(*scene), folder_ / name, {}, gate));
        EXPECT_EQ(asked, 1) << name;
        EXPECT_TRUE(fs::exists(folder_ / name));
    }
}

TEST_F(ExportTest, AFolderThatIsAFileIsRefusedByName) {
    const ScenePtr scene = fixtures::cubeScene();
    std::ofstream(folder_ / "file") << "not a folder";
    for (const char* name : {"cube.glb", "cube.gltf"}) {
        const auto report = exportScene(*scene, fullLod(*scene), folder_ / "file" / name, {});
        ASSERT_FALSE(report) << name;
        EXPECT_EQ(report.error().kind, ErrorKind::Failed);
        EXPECT_EQ(report.error().message.find('\n'), std::string::npos);
    }
    EXPECT_EQ(folderBytes(), std::string("not a folder").size());
}

TEST_F(ExportTest, ADeviceIsNotReplacedByAFile) {
    const ScenePtr scene = fixtures::cubeScene();
    const auto report = exportScene(*scene, fullLod(*scene), "/dev/full", {});
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("not a regular file"), std::string::npos);
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(ExportTest, AnOldFileSurvivesALodThatCannotBeWritten) {
    const ScenePtr scene = fixtures::cubeScene();
    const fs::path path = folder_ / "cube.glb";
    ASSERT_TRUE(exportScene(*scene, fullLod(*scene), path, {}));
    const std::uint64_t before = folderBytes();
    Lod broken = fullLod(*scene);
    Geometry geometry = *broken.submeshes[0].primitives[0];
    geometry.positions[0].x = std::nanf("");
    broken.submeshes[0].primitives[0] = std::make_shared<const Geometry>(geometry);
    const auto report = exportScene(*scene, broken, path, {});
    ASSERT_FALSE(report);
    EXPECT_NE(report.error().message.find("not finite"), std::string::npos);
    EXPECT_EQ(folderBytes(), before);
    EXPECT_TRUE(importScene(path, {}));
}

} // namespace
} // namespace lodestone
