#include "scene/export.h"
#include "tests/scene/scene_fixtures.h"

#include <array>
#include <filesystem>
#include <gtest/gtest.h>
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
