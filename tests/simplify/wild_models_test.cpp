// Wild takes whatever there is: it must reach a thousandth of the triangles.
#include "scene/expand.h"
#include "scene/import.h"
#include "tests/models_folder.h"
#include "tests/simplify/damaged_meshes.h"
#include "tests/simplify/meshes.h"

using namespace lodestone;
using namespace lodestone::meshes;
using lodestone::tests::modelFiles;

namespace {

class WildModels : public lodestone::tests::ModelsTest {};

} // namespace

TEST(WildDefects, TwoHundredDamagedMeshesReachAThousandth) {
    for (unsigned seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE(seed);
        expectWildReachesAThousandth(
            sceneOf({submeshOf({damagedMesh(seed)})}, {{glm::dmat4(1.0)}}));
    }
}

TEST_F(WildModels, EverySingleMeshOfMoreThanAThousandTrianglesReachesAThousandth) {
    constexpr std::uint64_t kLargest = 300'000; // larger ones take too long here
    int reached = 0;
    for (const std::filesystem::path& file : modelFiles()) {
        const Result<ScenePtr> scene = importScene(file, {});
        if (!scene)
            continue;
        const std::uint64_t triangles = countScene(**scene).triangles;
        if (triangles <= 1000 || triangles > kLargest)
            continue;
        SCOPED_TRACE(file.string());
        expectWildReachesAThousandth(*scene);
        ++reached;
    }
    EXPECT_GT(reached, 40);
}
