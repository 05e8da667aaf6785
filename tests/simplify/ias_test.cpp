#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>

using namespace lodestone;

namespace {

const ParameterValues kPaperSwitch{{"ips-switch", 1.0}};
const ParameterValues kSizeSwitch{{"ips-switch", 2.0}};

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

namespace {

std::uint64_t bytesAtAFifth(const LodSource& source) {
    const ByteModel bytes(source.scene(), {});
    return bytes.bytes(source.shapeAt(source.resolve({Target::Kind::Ratio, 0.2}, bytes).position));
}

// Thirty submeshes with an instance each, of all sizes: four triangles of each small one are dearer
// than what one mesh of them all keeps.
ScenePtr scrapScene() {
    std::vector<Submesh> submeshes;
    std::vector<std::vector<glm::dmat4>> places;
    for (int i = 0; i < 30; ++i) {
        submeshes.push_back(meshes::submeshOf({meshes::sphere(4, 6)}));
        glm::dmat4 place(0.1 + 0.3 * i);
        place[3] = {3.0 * i * i, 0.0, 0.0, 1.0};
        places.push_back({place});
    }
    return meshes::sceneOf(std::move(submeshes), places);
}

} // namespace

TEST(Ias, BySizeASceneIsExpandedWhereThatMakesItsFileSmaller) {
    const ScenePtr scene = scrapScene();
    const LodSourcePtr apart = iasOf(scene, {});
    const LodSourcePtr chosen = iasOf(scene, kSizeSwitch);
    const LodSourcePtr quadric = *findAlgorithm("quadric")->prepare(scene, {}, {}, {});
    ASSERT_LT(bytesAtAFifth(*quadric), bytesAtAFifth(*apart));
    EXPECT_EQ(bytesAtAFifth(*chosen), bytesAtAFifth(*quadric));
    ASSERT_EQ(chosen->notes().size(), 1U);
    EXPECT_NE(chosen->notes()[0].find("smaller"), std::string::npos);
}

TEST(Ias, BySizeInstancesStayWhereTheyMakeTheFileSmaller) {
    const ScenePtr scene = pairScene(12);
    const LodSourcePtr source = iasOf(scene, kSizeSwitch);
    EXPECT_EQ(source->scene(), scene);
    EXPECT_TRUE(source->notes().empty());
}

TEST(Ias, BySizeNothingIsExpandedThatHasAnImportanceOfItsOwn) {
    const ScenePtr scene = scrapScene();
    const ScheduleOptions schedule{Ordering::Triangle, std::vector<double>(30, 2.0), {}};
    EXPECT_EQ((*findAlgorithm("ias")->prepare(scene, kSizeSwitch, schedule, {}))->scene(), scene);
}

// At 5 % a crown of coarse leaves shows more of the tree than fewer and larger leaves in full
// shape.
TEST(Ias, LeavesGetCoarseBeforeTheyGo) {
    const ScenePtr maple = *generateScene("maple");
    const auto instances = [&](const ParameterValues& values) {
        const LodSourcePtr source = iasOf(maple, values);
        const Resolved at = source->resolve({Target::Kind::Ratio, 0.05}, ByteModel(maple, {}));
        return source->readOut(at.position, nullptr).instances;
    };
    EXPECT_GE(instances({}), maple->instances.size() * 99 / 100);
    EXPECT_LT(instances({{"shape-floor", 0.8}}), maple->instances.size() * 9 / 10);
}
