#include "render/pick_box.h"
#include "tests/render/view_fixture.h"

#include <gtest/gtest.h>

namespace lodestone {
namespace {

using namespace tests;

class PickBoxTest : public ViewTest {
protected:
    // Squares of side 2 around x = -1 and x = 1, the second one with a third behind it.
    void SetUp() override {
        ViewTest::SetUp();
        if (!context_)
            return;
        const auto scene = sceneOf(square(true), unlit(glm::vec4(1.0f)));
        scene->instances.resize(3);
        scene->instances[0].transform[3] = glm::dvec4(-1.0, 0.0, 0.0, 1.0);
        scene->instances[1].transform[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
        scene->instances[2].transform[3] = glm::dvec4(1.0, 0.0, -3.0, 1.0);
        load(scene);
    }

    // x, y: -2..2, y up.
    std::vector<Highlight> picked(const glm::dvec2& low, const glm::dvec2& high) const {
        return pickBox(input_,
                       {{(low.x + 2.0) / 4.0, (2.0 - high.y) / 4.0},
                        {(high.x + 2.0) / 4.0, (2.0 - low.y) / 4.0}});
    }
};

TEST_F(PickBoxTest, FindsWhatHasAVertexInTheBoxAndWhatIsBehindIt) {
    EXPECT_EQ(picked({-2.0, 0.5}, {-1.5, 1.5}), (std::vector<Highlight>{{0, 0}}));
    EXPECT_EQ(picked({1.5, 0.5}, {2.0, 1.5}), (std::vector<Highlight>{{0, 1}, {0, 2}}));
    EXPECT_EQ(picked({-2.0, -2.0}, {2.0, 2.0}), (std::vector<Highlight>{{0, 0}, {0, 1}, {0, 2}}));
    EXPECT_TRUE(picked({-1.2, -0.5}, {-0.8, 0.5}).empty()) << "no vertex there";
}

TEST_F(PickBoxTest, LeavesOutWhatIsHiddenOrRemoved) {
    const ScenePtr scene = gpu_->scene();
    Lod lod = fullLod(*scene);
    lod.submeshes[0].instance_order =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{2, 0, 1});
    lod.submeshes[0].kept_instances = 2;
    ASSERT_TRUE(gpu_->update(lod_, lod));
    EXPECT_EQ(picked({-2.0, -2.0}, {2.0, 2.0}), (std::vector<Highlight>{{0, 0}, {0, 2}}));
    gpu_->setHiddenSubmeshes({true});
    EXPECT_TRUE(picked({-2.0, -2.0}, {2.0, 2.0}).empty());
}

TEST_F(PickBoxTest, LooksOnlyInFrontOfThePerspectiveCamera) {
    input_.camera.orthographic = false;
    input_.camera.target = {0.0, 0.0, -6.05}; // the eye is just behind the first two squares
    input_.camera.distance = 6.0;
    EXPECT_EQ(picked({-8.0, -8.0}, {8.0, 8.0}), (std::vector<Highlight>{{0, 2}}));
}

} // namespace
} // namespace lodestone
