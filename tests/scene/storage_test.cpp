// Instancing::Auto: which submeshes keep their instances and which are expanded.
#include "scene/export.h"
#include "scene/import.h"
#include "scene/scene_builder.h"
#include "scene/storage.h"
#include "simplify/algorithm.h"
#include "tests/scene/scene_fixtures.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>
#include <span>
#include <unistd.h>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

struct Part {
    std::uint32_t quads_per_side = 4;
    std::uint32_t instances = 1;
};

// A bumpy patch for each part, no two alike, its instances all over the place.
ScenePtr patchScene(std::span<const Part> parts, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    SceneBuilder builder("patches");
    for (const Part& part : parts) {
        Geometry patch = *fixtures::gridGeometry(part.quads_per_side);
        for (glm::vec3& position : patch.positions)
            position.z = static_cast<float>(0.1 * any(random));
        Submesh submesh;
        submesh.primitives.push_back({});
        submesh.primitives[0].geometry = std::make_shared<const Geometry>(std::move(patch));
        const std::uint32_t index = builder.addSubmesh(std::move(submesh));
        for (std::uint32_t i = 0; i < part.instances; ++i) {
            const glm::dvec3 at(20.0 * any(random), 20.0 * any(random), 20.0 * any(random));
            builder.addNode("patch " + std::to_string(i),
                            kNone,
                            glm::rotate(glm::translate(glm::dmat4(1.0), at),
                                        3.0 * any(random),
                                        {0.0, 0.6, 0.8}),
                            index);
        }
    }
    return builder.finish();
}

LodSourcePtr iasOf(const ScenePtr& scene) {
    return *findAlgorithm("ias")->prepare(scene, {}, {}, {});
}

class StorageTest : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("lodestone_storage_" + std::to_string(::getpid()));
        fs::create_directories(folder_);
    }

    void TearDown() override { fs::remove_all(folder_); }

    ExportReport written(const Scene& scene, const Lod& lod, const ExportOptions& options = {}) {
        const auto report = exportScene(scene, lod, path(), options);
        EXPECT_TRUE(report);
        EXPECT_EQ(report->bytes, fs::file_size(path()));
        return report.value_or(ExportReport{});
    }

    ScenePtr readBack() { return *importScene(path(), {}); }

    fs::path path() const { return folder_ / "scene.glb"; }

    fs::path folder_;
};

bool saysExpanded(const ExportReport& report) {
    return std::ranges::any_of(report.notes, [](const std::string& note) {
        return note.find("smaller expanded and merged") != std::string::npos;
    });
}

TEST_F(StorageTest, ManySmallSinglesOfOneMaterialAreMergedAndANoteSaysSo) {
    const ScenePtr scene = patchScene(std::vector<Part>(12), 1);
    const LodSourcePtr source = iasOf(scene);
    const Lod lod = source->readOut(source->positionCount() / 2, nullptr);
    const ExportReport report = written(*scene, lod);
    EXPECT_TRUE(saysExpanded(report));
    const ScenePtr again = readBack();
    EXPECT_EQ(countScene(*again).submeshes, 1U);
    EXPECT_EQ(countScene(*again).triangles, lod.triangles);
}

TEST_F(StorageTest, AnUntouchedSceneKeepsItsMeshesAndNodes) {
    const ScenePtr scene = patchScene(std::vector<Part>(12), 1);
    EXPECT_FALSE(saysExpanded(written(*scene, fullLod(*scene))));
    EXPECT_EQ(countScene(*readBack()).submeshes, 12U);
}

TEST_F(StorageTest, ACrowdStaysInstancedBesideSinglesThatMerge) {
    std::vector<Part> parts(9);
    parts.push_back({12, 300});
    const ScenePtr scene = patchScene(parts, 2);
    const LodSourcePtr source = iasOf(scene);
    const Resolved half = source->resolve({Target::Kind::Ratio, 0.5}, ByteModel(scene, {}));
    const Lod lod = source->readOut(half.position, nullptr);
    EXPECT_TRUE(saysExpanded(written(*scene, lod)));
    const SceneCounts counts = countScene(*readBack());
    EXPECT_EQ(counts.submeshes, 2U) << "the crowd's, and what the singles became";
    EXPECT_EQ(counts.instances, lod.submeshes.back().kept_instances + 1U);
    EXPECT_EQ(counts.triangles, lod.triangles);
}

TEST_F(StorageTest, AStoredLodCountsWhatIsMergedAndWhatStaysApart) {
    std::vector<Part> parts(9);
    parts.push_back({12, 300});
    const ScenePtr scene = patchScene(parts, 2);
    const LodSourcePtr source = iasOf(scene);
    const Lod lod = source->readOut(source->positionCount() / 2, nullptr);
    const StoragePlan storage(*scene, {});
    const StoredShape stored = storage.smallest(shapeOf(*scene, lod));
    ASSERT_GT(stored.way, 0U);
    const Result<Lod> written = storage.storedLod(lod, stored.way);
    ASSERT_TRUE(written);
    EXPECT_EQ(written->triangles, lod.triangles);
    EXPECT_EQ(written->instances, lod.submeshes.back().kept_instances + 1U);
}

TEST_F(StorageTest, ALoneInstanceIsStoredWithoutItsNodesWhereThatIsSmallerAndKeepsItsName) {
    SceneBuilder builder("lone");
    Submesh submesh;
    submesh.name = "sheet";
    submesh.primitives.push_back({});
    submesh.primitives[0].geometry = fixtures::gridGeometry(6);
    const std::uint32_t sheet = builder.addSubmesh(std::move(submesh));
    const std::uint32_t group =
        builder.addNode("group", kNone, glm::translate(glm::dmat4(1.0), {1.0, 2.0, 3.0}));
    builder.addNode("piece", group, glm::scale(glm::dmat4(1.0), glm::dvec3(2.0)), sheet);
    const ScenePtr scene = builder.finish();
    const LodSourcePtr source = iasOf(scene);
    const Lod lod = source->readOut(source->positionCount() - 1, nullptr);
    EXPECT_TRUE(saysExpanded(written(*scene, lod)));
    const ScenePtr again = readBack();
    ASSERT_EQ(again->submeshes.size(), 1U);
    EXPECT_EQ(again->submeshes[0].name, "sheet");
    EXPECT_EQ(again->nodes.size(), 1U);
    EXPECT_EQ(countScene(*again).triangles, lod.triangles);
    EXPECT_LE(glm::length(worldBounds(*again).max - glm::dvec3(3.0, 4.0, 3.0)), 1e-6);
}

TEST_F(StorageTest, OtherWaysNeverExpand) {
    const ScenePtr scene = patchScene(std::vector<Part>(12), 1);
    const LodSourcePtr source = iasOf(scene);
    const Lod lod = source->readOut(source->positionCount() / 2, nullptr);
    for (const Instancing instancing : {Instancing::Nodes, Instancing::Gpu}) {
        EXPECT_FALSE(saysExpanded(written(*scene, lod, {instancing})));
        EXPECT_EQ(countScene(*readBack()).submeshes, 12U);
    }
}

// Mixes of parts in which every way of storage wins somewhere.
ScenePtr mixedScene(std::mt19937& random) {
    std::vector<Part> parts(1 + random() % 8);
    for (Part& part : parts) {
        part.quads_per_side = static_cast<std::uint32_t>(1 + random() % 6);
        part.instances = static_cast<std::uint32_t>(random() % 3 == 0 ? 1 + random() % 40 : 1);
    }
    return patchScene(parts, static_cast<std::uint32_t>(random()));
}

TEST_F(StorageTest, AutoIsNeverLargerThanAnyOtherWayAndPredictedToTheByte) {
    std::mt19937 random(7);
    for (int round = 0; round < 30; ++round) {
        const ScenePtr scene = mixedScene(random);
        const LodSourcePtr source = iasOf(scene);
        const ByteModel automatic(scene, {});
        const std::array others{ByteModel(scene, {Instancing::Nodes}),
                                ByteModel(scene, {Instancing::Gpu}),
                                ByteModel(scene, {Instancing::Expand})};
        for (std::uint64_t eighth = 1; eighth <= 8; ++eighth) {
            const std::uint64_t position = (source->positionCount() - 1) * eighth / 8;
            if (position == 0)
                continue;
            const Lod lod = source->readOut(position, nullptr);
            const std::uint64_t bytes = automatic.bytes(source->shapeAt(position));
            for (const ByteModel& other : others)
                EXPECT_LE(bytes, other.bytes(source->shapeAt(position)))
                    << "round " << round << ", eighth " << eighth;
            EXPECT_EQ(bytes, written(*scene, lod).bytes)
                << "round " << round << ", eighth " << eighth;
        }
    }
}

TEST_F(StorageTest, QuantisedFilesAreChosenAndPredictedAlike) {
    const ScenePtr scene = patchScene(std::vector<Part>(12), 3);
    const LodSourcePtr source = iasOf(scene);
    const std::uint64_t position = source->positionCount() / 2;
    const ExportOptions options{Instancing::Auto, Container::Glb, Compression::Quantize};
    const ExportReport report = written(*scene, source->readOut(position, nullptr), options);
    EXPECT_TRUE(saysExpanded(report));
    EXPECT_EQ(report.bytes, ByteModel(scene, options).bytes(source->shapeAt(position)));
    EXPECT_EQ(countScene(*readBack()).submeshes, 1U);
}

} // namespace
} // namespace lodestone
