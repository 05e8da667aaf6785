#include "scene/export.h"
#include "scene/scene_builder.h"
#include "tests/scene/scene_fixtures.h"

#include <array>
#include <filesystem>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>
#include <unistd.h>

namespace lodestone {
namespace {

namespace fs = std::filesystem;

constexpr std::array kEveryInstancing{
    Instancing::Auto, Instancing::Nodes, Instancing::Gpu, Instancing::Expand};

// The first index_count indices of every primitive and the first instances of every submesh.
Lod coarser(const Scene& scene, std::uint32_t kept_instances, std::size_t index_count) {
    Lod lod = fullLod(scene);
    for (LodSubmesh& submesh : lod.submeshes) {
        submesh.kept_instances = std::min(submesh.kept_instances, kept_instances);
        for (GeometryPtr& geometry : submesh.primitives) {
            Geometry fewer = *geometry;
            fewer.indices.resize(std::min(index_count, fewer.indices.size()));
            geometry = std::make_shared<const Geometry>(std::move(fewer));
        }
    }
    return lod;
}

std::uint64_t writtenBytes(const Scene& scene, const Lod& lod, const ExportOptions& options) {
    const fs::path folder =
        fs::temp_directory_path() / ("lodestone_byte_model_" + std::to_string(::getpid()));
    fs::remove_all(folder);
    fs::create_directories(folder);
    const char* const name = options.container == Container::Glb ? "scene.glb" : "scene.gltf";
    EXPECT_TRUE(exportScene(scene, lod, folder / name, options));
    std::uint64_t bytes = 0;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
        bytes += entry.is_regular_file() ? entry.file_size() : 0;
    fs::remove_all(folder);
    return bytes;
}

TEST(ByteModel, PredictsEveryLodOfEveryFixtureToTheByte) {
    for (const ScenePtr& scene : {fixtures::twoMaterialCubeScene(),
                                  fixtures::awkwardInstancesScene(),
                                  fixtures::texturedQuadScene(),
                                  fixtures::cubeRowScene(50)})
        for (const Instancing instancing : kEveryInstancing)
            for (const Container container : {Container::Glb, Container::Gltf}) {
                const ExportOptions options{instancing, container};
                const ByteModel model(scene, options);
                for (const std::uint32_t kept : {50U, 11U, 3U, 1U}) {
                    const Lod lod = coarser(*scene, kept, 3U * kept);
                    EXPECT_EQ(model.bytes(shapeOf(*scene, lod)), writtenBytes(*scene, lod, options))
                        << scene->name << ", instancing " << static_cast<int>(instancing)
                        << ", container " << static_cast<int>(container) << ", kept " << kept;
                }
            }
}

TEST(ByteModel, EveryTriangleAndInstanceLessIsStrictlySmaller) {
    const ScenePtr scene = fixtures::cubeRowScene(40);
    for (const Instancing instancing : kEveryInstancing) {
        const ByteModel model(scene, {instancing});
        LodShape shape = shapeOf(*scene, fullLod(*scene));
        std::uint64_t before = model.bytes(shape);
        shape.submeshes[0].changed = true;
        for (std::uint32_t step = 0; step < 39 + 10; ++step) {
            if (step % 5 == 4)
                shape.submeshes[0].primitives[0].indices -= 3;
            else
                --shape.submeshes[0].kept_instances;
            const std::uint64_t after = model.bytes(shape);
            EXPECT_LT(after, before)
                << "instancing " << static_cast<int>(instancing) << ", step " << step;
            before = after;
            if (shape.submeshes[0].kept_instances == 1)
                break;
        }
    }
}

// Submeshes with few instances each, where rows and nodes weigh about the same.
ScenePtr closeCallsScene(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-9.0, 9.0);
    SceneBuilder builder("close calls");
    const std::uint32_t submesh_count = 1 + static_cast<std::uint32_t>(random() % 5);
    for (std::uint32_t s = 0; s < submesh_count; ++s) {
        Submesh submesh;
        submesh.primitives.push_back({});
        submesh.primitives[0].geometry = fixtures::cubeGeometry();
        const std::uint32_t index = builder.addSubmesh(std::move(submesh));
        const bool named = random() % 2 == 0;
        const double turn_rad = random() % 2 == 0 ? 0.0 : 1.0;
        const std::uint32_t count = 1 + static_cast<std::uint32_t>(random() % 14);
        for (std::uint32_t i = 0; i < count; ++i) {
            const glm::dvec3 at(place(random), place(random), place(random));
            builder.addNode(
                named ? "a long name of a node " + std::to_string(i) : "",
                kNone,
                glm::rotate(glm::translate(glm::dmat4(1.0), at), turn_rad * i, {0.0, 1.0, 0.0}),
                index);
        }
    }
    return builder.finish();
}

TEST(ByteModel, AutoIsNeverLargerThanEitherWayAndFallsWithEveryInstance) {
    std::mt19937 random(5);
    for (int round = 0; round < 40; ++round) {
        const ScenePtr scene = closeCallsScene(random);
        const ByteModel automatic(scene, {Instancing::Auto});
        const ByteModel nodes(scene, {Instancing::Nodes});
        const ByteModel gpu(scene, {Instancing::Gpu});
        LodShape shape = shapeOf(*scene, fullLod(*scene));
        for (std::uint64_t before = ~std::uint64_t{0};;) {
            const std::uint64_t bytes = automatic.bytes(shape);
            ASSERT_LE(bytes, std::min(nodes.bytes(shape), gpu.bytes(shape))) << "round " << round;
            ASSERT_LT(bytes, before) << "round " << round;
            before = bytes;
            std::vector<LodShape::SubmeshShape*> removable;
            for (LodShape::SubmeshShape& submesh : shape.submeshes)
                if (submesh.kept_instances > 1)
                    removable.push_back(&submesh);
            if (removable.empty())
                break;
            --removable[random() % removable.size()]->kept_instances;
        }
    }
}

TEST(ByteModel, IndicesTake16BitsUpTo65535Vertices) {
    const ScenePtr scene = fixtures::cubeScene();
    const ByteModel model(scene, {});
    LodShape shape = shapeOf(*scene, fullLod(*scene));
    shape.submeshes[0].changed = true;
    shape.submeshes[0].primitives[0] = {65535, 300000};
    const std::uint64_t narrow = model.bytes(shape);
    shape.submeshes[0].primitives[0] = {65536, 300000};
    const std::uint64_t wide = model.bytes(shape);
    EXPECT_EQ(wide - narrow, 2 * 300000U + 32U);
}

TEST(ByteModel, RatesAreThoseOfTheStoredTypes) {
    const ScenePtr scene = fixtures::cubeRowScene(50);
    const ByteModel gpu(scene, {Instancing::Gpu});
    EXPECT_DOUBLE_EQ(gpu.bytesPerVertex(0, 0), 12 + 12 + 8);
    EXPECT_DOUBLE_EQ(gpu.bytesPerTriangle(0, 0), 6);
    EXPECT_DOUBLE_EQ(gpu.bytesPerInstance(0), 12) << "pure translations";
    const ByteModel expanded(scene, {Instancing::Expand});
    EXPECT_DOUBLE_EQ(expanded.bytesPerVertex(0, 0), 50 * 32);
    EXPECT_GT(ByteModel(scene, {Instancing::Nodes}).bytesPerInstance(0), 40);
}

} // namespace
} // namespace lodestone
