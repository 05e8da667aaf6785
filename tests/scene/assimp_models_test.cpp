#include "scene/assimp/assimp_import.h"
#include "tests/models_folder.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <set>

namespace lodestone {

namespace {

namespace fs = std::filesystem;

using AssimpModels = tests::ModelsTest;

std::vector<fs::path> modelFiles() {
    const std::set<std::string> wanted{".dae", ".3ds", ".obj", ".ply", ".stl", ".fbx"};
    std::vector<fs::path> files;
    for (const auto& entry : fs::recursive_directory_iterator(tests::modelsFolder())) {
        std::string extension = entry.path().extension().string();
        std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
            return static_cast<char>(std::tolower(letter));
        });
        if (wanted.contains(extension))
            files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

} // namespace

TEST_F(AssimpModels, CountsAreThoseOfTheModelList) {
    struct Expected {
        const char* file;
        std::uint64_t unique_triangles;
        std::uint64_t triangles;
    };

    constexpr std::array<Expected, 14> kExpected{{
        {"instanced/2CylinderEngine-dae/2_cylinder_engine.dae", 75730, 121496},
        {"instanced/cafe/cafe.dae", 12658, 23834},
        {"instanced/teapot_instancenodes/teapot_instancenodes.DAE", 1024, 2048},
        {"meshes/bun_zipper/bun_zipper.ply", 69451, 69451},
        {"meshes/horse/horse.ply", 96966, 96966},
        {"meshes/armadillo/armadillo.obj", 86482, 86482},
        {"meshes/monkeys_on_landscape/monkeys_on_landscape_binary_with_normals_etc.ply",
         63746,
         63746},
        {"meshes/tray_bottom-stl/1002_tray_bottom.STL", 4520, 4520},
        {"meshes/wuson-stl/Wuson.stl", 3732, 3732},
        {"meshes/p47d-3ds/p47d.3ds", 3500, 3500},
        {"meshes/jeep-3ds/jeep1.3ds", 2032, 2032},
        {"textured/collapsed_fire_station/collapsed_fire_station.dae", 2899, 2899},
        {"textured/office/office.obj", 33502, 33502},
        {"textured/spider-obj/spider.obj", 1368, 1368},
    }};
    for (const Expected& expected : kExpected) {
        const Result<ScenePtr> scene = importWithAssimp(tests::modelsFolder() / expected.file, {});
        ASSERT_TRUE(scene) << scene.error().message;
        const SceneCounts counts = countScene(**scene);
        EXPECT_EQ(counts.unique_triangles, expected.unique_triangles) << expected.file;
        EXPECT_EQ(counts.triangles, expected.triangles) << expected.file;
    }
}

TEST_F(AssimpModels, EachGoodOneImportsAndEachBadOneImportsOrSaysWhy) {
    const std::vector<fs::path> files = modelFiles();
    EXPECT_GT(files.size(), 60u);
    for (const fs::path& file : files) {
        const Result<ScenePtr> scene = importWithAssimp(file, {});
        const bool bad = file.string().find("/bad/") != std::string::npos;
        // The one without a mesh: a camera and lights.
        if (file.filename() == "lights.dae") {
            EXPECT_FALSE(scene);
            continue;
        }
        EXPECT_TRUE(scene || bad) << scene.error().message;
        if (!scene) {
            EXPECT_EQ(scene.error().kind, ErrorKind::BadInput) << file;
            EXPECT_TRUE(scene.error().message.starts_with(file.filename().string() + ": "));
            EXPECT_EQ(scene.error().message.find('\n'), std::string::npos) << file;
            continue;
        }
        EXPECT_FALSE((*scene)->instances.empty()) << file;
        for (const Submesh& submesh : (*scene)->submeshes)
            for (const Primitive& primitive : submesh.primitives)
                for (const std::uint32_t index : primitive.geometry->indices)
                    ASSERT_LT(index, primitive.geometry->positions.size()) << file;
    }
}

} // namespace lodestone
