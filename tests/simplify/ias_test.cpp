#include "simplify/algorithm.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

const ParameterValues kPaperSwitch{{"ips-switch", 1.0}};

LodSourcePtr iasOf(const ScenePtr& scene, const ParameterValues& values) {
    return *findAlgorithm("ias")->prepare(scene, values, {}, {});
}

// Two submeshes, 1 and `second` instances.
ScenePtr pairScene(int second) {
    std::vector<glm::dmat4> places(static_cast<std::size_t>(second), glm::dmat4(1.0));
    for (std::size_t i = 0; i < places.size(); ++i)
        places[i][3].x = 3.0 * static_cast<double>(i + 1);
    return meshes::sceneOf(
        {meshes::submeshOf({meshes::sphere(8, 12)}), meshes::submeshOf({meshes::torus(10, 8)})},
        {{glm::dmat4(1.0)}, places});
}

} // namespace

TEST(Ias, ThePapersSwitchSimplifiesScenesOfFewInstancesAsOne) {
    const ScenePtr scene = pairScene(2); // 1.5 a submesh
    const LodSourcePtr source = iasOf(scene, kPaperSwitch);
    EXPECT_EQ(source->scene()->submeshes.size(), 1U);
    EXPECT_EQ(source->trianglesAt(0), countScene(*scene).triangles);
    ASSERT_EQ(source->notes().size(), 1U);
    EXPECT_NE(source->notes()[0].find("1.50 instances per submesh"), std::string::npos);
    const LodSourcePtr quadric = *findAlgorithm("quadric")->prepare(scene, {}, {}, {});
    EXPECT_EQ(source->positionCount(), quadric->positionCount());
}

TEST(Ias, ThePapersSwitchLeavesInstancedScenesAlone) {
    const ScenePtr scene = pairScene(3); // 2 a submesh
    const LodSourcePtr source = iasOf(scene, kPaperSwitch);
    EXPECT_EQ(source->scene(), scene);
    EXPECT_TRUE(source->notes().empty());
}

TEST(Ias, WithoutThePapersSwitchNoSceneIsExpanded) {
    const ScenePtr scene = pairScene(1);
    EXPECT_EQ(iasOf(scene, {})->scene(), scene);
}
