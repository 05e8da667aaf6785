#include "scene/import.h"
#include "tests/models_folder.h"

#include <functional>

using namespace lodestone;
using lodestone::tests::modelsFolder;

namespace {

class ModelsImport : public lodestone::tests::ModelsTest {};

struct Fact {
    const char* file;
    std::uint64_t instances; // draws of meshes, not of primitives
    std::uint64_t unique_triangles;
    std::uint64_t triangles;
};

// Triangles as the models' README tells them.
constexpr Fact kFacts[] = {
    {"instanced/2CylinderEngine-glb/2CylinderEngine.glb", 67, 75730, 121496},
    {"instanced/WestRiverSideHospital-fireAlarms/fireAlarms.gltf", 867, 4258, 398698},
    {"instanced/duplex/scene.gltf",
     291,
     26302,
     78102}, // the README's 30,990 has undrawn meshes too
    {"instanced/TeapotsGalore/TeapotsGalore.gltf", 1900, 4034, 7656770},
    {"instanced/SimpleInstancing/simple-instancing.glb", 125, 12, 1500},
    {"instanced/InstanceTest/InstanceTest.glb", 2500, 80, 200000},
    {"instanced/castle/castle.gltf", 28, 8318, 24614},
    {"instanced/VirtualCity/VC.gltf", 135, 8383, 8383},
    {"instanced/pins/pins.glb", 7, 1838, 3408},
    {"instanced/CesiumMilkTruck/CesiumMilkTruck.glb", 3, 2856, 3624},
    {"instanced/CubeScaledInstances/cube_att.gltf", 4, 12, 48},
    {"instanced/SpheresScaledInstances/spheres_scaled_instances.gltf", 3, 224, 672},
    {"instanced/reflection_scene/reflection_scene.gltf", 12, 55626, 78666},
    {"instanced/many-cubes/many-cubes.gltf", 501, 6012, 6012},
    {"instanced/mode5-strips/mode5.gltf", 54, 2786, 2786},
    {"textured/Duck/Duck.glb", 1, 4212, 4212},
    {"textured/DamagedHelmet/DamagedHelmet.glb", 1, 15452, 15452},
    {"features/PrimitiveMode/Mesh_PrimitiveMode_05.gltf", 1, 2, 2},
    {"features/SimpleSparseAccessor/SimpleSparseAccessor.gltf", 1, 12, 12},
    {"features/TextureTransformTest/TextureTransformTest.gltf", 12, 18, 24},
    {"features/MeshPrimitiveModes/MeshPrimitiveModes.gltf", 7, 16, 16},
    {"features/cubeQuantized/cubeQuantized.glb", 1, 12, 12},
    {"features/InterpolationTest/InterpolationTest.gltf", 10, 14, 110},
    {"features/CesiumMan/CesiumMan.glb", 1, 4672, 4672},
    {"instanced/2CylinderEngine-draco/2CylinderEngine.gltf", 67, 65311, 110336},
    {"features/BoxDraco/Box_Draco.glb", 1, 12, 12},
    {"features/DuckDraco/Duck.gltf", 1, 4212, 4212},
    {"features/BoxMeshopt/BoxMeshopt.glb", 1, 12, 12},
    {"features/DuckMeshopt/Duck-vp-12-vt-12-vn-12.glb", 1, 4212, 4212},
};

bool isGltf(const std::filesystem::path& file) {
    return file.extension() == ".gltf" || file.extension() == ".glb";
}

} // namespace

TEST_F(ModelsImport, CountsAreThoseOfTheModelList) {
    for (const Fact& fact : kFacts) {
        const Result<ScenePtr> scene = importScene(modelsFolder() / fact.file, {});
        ASSERT_TRUE(scene) << scene.error().message;
        const SceneCounts counts = countScene(**scene);
        EXPECT_EQ(counts.instances, fact.instances) << fact.file;
        EXPECT_EQ(counts.unique_triangles, fact.unique_triangles) << fact.file;
        EXPECT_EQ(counts.triangles, fact.triangles) << fact.file;
    }
}

TEST_F(ModelsImport, EveryGltfImportsOrTellsWhyInOneLine) {
    std::vector<std::filesystem::path> files = importableFiles(modelsFolder());
    std::erase_if(files, std::not_fn(isGltf));
    EXPECT_GT(files.size(), 90u);
    for (const std::filesystem::path& file : files) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (scene) {
            EXPECT_GT((*scene)->instances.size(), 0u) << file;
            EXPECT_EQ((*scene)->name, file.filename().string());
            continue;
        }
        const std::string& message = scene.error().message;
        EXPECT_EQ(scene.error().kind, ErrorKind::BadInput) << message;
        EXPECT_TRUE(message.starts_with(file.filename().string() + ": ")) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_LT(message.size(), 300u) << message;
    }
}

TEST_F(ModelsImport, NoModelOutsideTheBadOnesIsRefused) {
    for (const std::filesystem::path& file : tests::modelFiles()) {
        if (!isGltf(file))
            continue;
        const Result<ScenePtr> scene = importScene(file, {});
        EXPECT_TRUE(scene) << scene.error().message;
    }
}
