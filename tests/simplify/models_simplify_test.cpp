#include "scene/finite.h"
#include "scene/import.h"
#include "simplify/algorithm.h"
#include "tests/models_folder.h"
#include "tests/simplify/meshes.h"

#include <algorithm>

using namespace lodestone;
using lodestone::tests::modelFiles;

namespace {

class ModelsSimplify : public lodestone::tests::ModelsTest {};

constexpr std::uint64_t kLargest = 250'000; // unique triangles: larger ones take too long here

void expectSound(const Geometry& geometry) {
    for (const glm::vec3& p : geometry.positions)
        ASSERT_TRUE(isFinite(p));
    for (const std::uint32_t index : geometry.indices)
        ASSERT_LT(index, geometry.positions.size());
    for (const Attribute& attribute : geometry.attributes)
        ASSERT_EQ(attribute.bytes.size(), geometry.positions.size() * attribute.stride());
}

void expectSoundLods(const LodSource& source) {
    const ByteModel bytes(source.scene(), {});
    for (const double ratio : {0.5, 0.1, 0.01, 0.001}) {
        const Resolved resolved = source.resolve({Target::Kind::Ratio, ratio}, bytes);
        EXPECT_EQ(resolved.met, resolved.note.empty());
        const Lod lod = source.readOut(resolved.position, nullptr);
        EXPECT_EQ(lod.triangles, source.trianglesAt(resolved.position));
        for (const LodSubmesh& submesh : lod.submeshes)
            for (const GeometryPtr& geometry : submesh.primitives)
                expectSound(*geometry);
    }
}

} // namespace

TEST_F(ModelsSimplify, EveryModelGivesSoundLodsByEveryAlgorithm) {
    int simplified = 0;
    for (const std::filesystem::path& file : modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene || countScene(**scene).unique_triangles > kLargest)
            continue;
        for (const Algorithm& algorithm : algorithms()) {
            if (algorithm.expands && countScene(**scene).triangles > kLargest)
                continue;
            SCOPED_TRACE(file.string() + " " + std::string(algorithm.id));
            const Result<LodSourcePtr> source = algorithm.prepare(*scene, {}, {}, {});
            ASSERT_TRUE(source) << source.error().message;
            expectSoundLods(**source);
            ++simplified;
        }
    }
    EXPECT_GT(simplified, 100);
}

// Closed by position, whatever the seams of its textures, normals and materials.
TEST_F(ModelsSimplify, ClosedModelsStayClosedAcrossSeamsAtAnyRatio) {
    int closed = 0;
    for (const std::filesystem::path& file : modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene || countScene(**scene).unique_triangles > kLargest)
            continue;
        const Result<LodSourcePtr> source =
            findAlgorithm("quadric-submesh")->prepare(*scene, {}, {}, {});
        ASSERT_TRUE(source) << source.error().message;
        const ByteModel bytes((*source)->scene(), {});
        std::vector<bool> was_closed;
        for (const double ratio : {1.0, 0.5, 0.2, 0.05, 0.01}) {
            const Resolved at = (*source)->resolve({Target::Kind::Ratio, ratio}, bytes);
            const Lod lod = (*source)->readOut(at.position, nullptr);
            for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
                const meshes::Shape shape = meshes::shapeOf(lod.submeshes[s].primitives);
                if (ratio == 1.0) {
                    const bool sound = shape.faces > 3 && shape.border_edges == 0 &&
                                       shape.non_manifold_edges == 0 && shape.degenerate_faces == 0;
                    was_closed.push_back(sound);
                    closed += sound ? 1 : 0;
                } else if (was_closed[s]) {
                    EXPECT_EQ(shape.border_edges, 0u)
                        << file << " mesh " << s << " at " << ratio << ", " << shape.faces;
                }
            }
        }
    }
    EXPECT_GT(closed, 20);
}
