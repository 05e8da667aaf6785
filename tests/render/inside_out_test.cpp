#include "simplify/algorithm.h"
#include "tests/models_folder.h"
#include "tests/render/view_fixture.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <iostream>
#include <numbers>
#include <set>

namespace lodestone {
namespace {

// Draws a scene's LODs with and without their back faces. A surface without holes covers the same
// pixels both ways: where only a back face is seen, one looks through a crack at the far inside.
class InsideOut : public tests::ViewTest {
protected:
    // Every material hides its back faces and nothing is transparent.
    static ScenePtr solid(const Scene& scene) {
        auto copy = std::make_shared<Scene>(scene);
        for (Material& material : copy->materials) {
            material.double_sided = false;
            material.alpha_mode = AlphaMode::Opaque;
        }
        return copy;
    }

    struct Seen {
        std::size_t covered = 0; // pixels, over all directions
        std::size_t holes = 0;   // where a back face alone is seen
        std::size_t inside = 0;  // where a back face lies before a front face
    };

    Seen look(const Scene& shown, const Lod& lod) {
        Seen seen;
        load(solid(shown), lod);
        input_.size = {kSide, kSide};
        input_.options.samples = 1;
        input_.options.shading = Shading::Normals;
        input_.options.background = Background::Transparent;
        const FramePoints points = gpu_->framePoints();
        for (const double up : {-1.2, -0.4, 0.4, 1.2})
            for (int around = 0; around < 6; ++around) {
                input_.camera.azimuth_rad = around * std::numbers::pi / 3.0 + up;
                input_.camera.elevation_rad = up;
                frameCamera(input_.camera, points, 1.0);
                const std::vector<std::uint8_t> front = drawWith(BackFaces::PerMaterial);
                const std::vector<std::uint8_t> both = drawWith(BackFaces::Shown);
                for (std::size_t i = 0; i < both.size(); i += 4) {
                    const bool is_covered = both[i + 3] != 0;
                    seen.covered += is_covered ? 1 : 0;
                    seen.holes += is_covered && front[i + 3] == 0 ? 1 : 0;
                    seen.inside += is_covered && !std::equal(&front[i], &front[i + 3], &both[i]);
                }
            }
        return seen;
    }

private:
    static constexpr std::uint32_t kSide = 256;

    std::vector<std::uint8_t> drawWith(BackFaces faces) {
        input_.options.back_faces = faces;
        return draw().rgba;
    }
};

// By position, across all seams and primitives.
bool isClosed(const Scene& scene) {
    return std::ranges::all_of(scene.submeshes, [](const Submesh& submesh) {
        std::vector<GeometryPtr> primitives;
        for (const Primitive& primitive : submesh.primitives) {
            if (primitive.mode != PrimitiveMode::Triangles)
                return false;
            primitives.push_back(primitive.geometry);
        }
        const meshes::Shape shape = meshes::shapeOf(primitives);
        return shape.faces > 100 && shape.border_edges == 0 && shape.non_manifold_edges == 0 &&
               shape.degenerate_faces == 0;
    });
}

// Vertices of its attributes lie several at one place: it has seams.
bool hasSeams(const Scene& scene) {
    std::size_t vertices = 0;
    std::size_t places = 0;
    for (const Submesh& submesh : scene.submeshes)
        for (const Primitive& primitive : submesh.primitives) {
            const std::vector<glm::vec3>& all = primitive.geometry->positions;
            vertices += all.size();
            places += std::set<glm::vec3, meshes::LessByPlace>(all.begin(), all.end()).size();
        }
    return vertices > places + places / 50;
}

TEST_F(InsideOut, NothingShinesThroughClosedModelsWithSeamsAtAnyRatio) {
    if (!std::filesystem::is_directory(tests::modelsFolder()))
        GTEST_SKIP() << "no models in " << tests::modelsFolder();
    constexpr std::uint64_t kLargest = 100'000;
    int models = 0;
    for (const std::filesystem::path& file : tests::modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene || countScene(**scene).triangles > kLargest || !isClosed(**scene) ||
            !hasSeams(**scene))
            continue;
        const Seen original = look(**scene, fullLod(**scene));
        if (original.holes > 0)
            continue; // its faces do not all look outwards
        ++models;
        for (const char* id : {"quadric", "ias"}) {
            const Result<LodSourcePtr> source = findAlgorithm(id)->prepare(*scene, {}, {}, {});
            ASSERT_TRUE(source) << source.error().message;
            const ByteModel bytes((*source)->scene(), {});
            for (const double ratio : {0.5, 0.2, 0.05}) {
                const Resolved at = (*source)->resolve({Target::Kind::Ratio, ratio}, bytes);
                const Seen seen =
                    look(*(*source)->scene(), (*source)->readOut(at.position, nullptr));
                EXPECT_GT(seen.covered, 1000u);
                EXPECT_EQ(seen.holes, 0u) << file << ' ' << id << " at " << ratio;
                std::cout << file.filename().string() << ' ' << id << ' ' << ratio << ": holes "
                          << seen.holes << ", inside seen " << seen.inside << " (original "
                          << original.inside << ") of " << seen.covered << " pixels\n";
            }
        }
    }
    EXPECT_GE(models, 5);
}

} // namespace
} // namespace lodestone
