#include "scene/import.h"
#include "simplify/algorithm.h"
#include "tests/models_folder.h"

#include <algorithm>
#include <cmath>

using namespace lodestone;
using lodestone::tests::modelFiles;

namespace {

class ModelsSimplify : public lodestone::tests::ModelsTest {};

constexpr std::uint64_t kLargest = 250'000; // unique triangles: larger ones take too long here

void expectSound(const Geometry& geometry) {
    for (const glm::vec3& p : geometry.positions)
        ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
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
