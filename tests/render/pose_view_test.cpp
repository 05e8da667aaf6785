#include "tests/render/view_fixture.h"
#include "tests/scene/gltf_maker.h"

namespace lodestone {
namespace {

using namespace tests;

// A white unlit square -0.5..0.5 of four vertices.
class PoseViewTest : public ViewTest {
protected:
    static GltfMaker squareFile() {
        GltfMaker maker;
        maker.addMesh({-0.5f, -0.5f, 0, 0.5f, -0.5f, 0, 0.5f, 0.5f, 0, -0.5f, 0.5f, 0},
                      {0, 1, 2, 0, 2, 3});
        maker.json["materials"] = {{{"extensions", {{"KHR_materials_unlit", nlohmann::json({})}}}}};
        maker.json["meshes"][0]["primitives"][0]["material"] = 0;
        return maker;
    }

    static nlohmann::json channel(std::size_t node, const char* path) {
        return {{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
    }

    // From the first values at 0 s to the second at 1 s.
    static void animate(GltfMaker& maker,
                        const std::vector<float>& values,
                        const char* type,
                        const nlohmann::json& channel) {
        const std::size_t times = maker.addAccessor(std::vector<float>{0, 1}, 5126, "SCALAR");
        const std::size_t output = maker.addAccessor(values, 5126, type);
        maker.json["animations"] = {
            {{"samplers", {{{"input", times}, {"output", output}}}}, {"channels", {channel}}}};
    }

    void loadAtOrigin(const GltfMaker& maker) {
        load(maker.scene());
        input_.camera.target = glm::dvec3(0.0);
        input_.camera.scene_center = glm::dvec3(0.0);
    }

    Pixels drawAt(double time_s) {
        input_.options.moment = {0, time_s};
        gpu_->setMoment(input_.options.moment);
        return draw();
    }

    static bool isLit(const Pixels& pixels, double x, double y) {
        return at(pixels, x, y)[0] > 200;
    }
};

TEST_F(PoseViewTest, SkinnedVerticesMoveWithTheirJoint) {
    GltfMaker maker = squareFile();
    auto& attributes = maker.json["meshes"][0]["primitives"][0]["attributes"];
    // The upper two hang on the second joint.
    attributes["JOINTS_0"] = maker.addAccessor(
        std::vector<std::uint16_t>{0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5123, "VEC4");
    attributes["WEIGHTS_0"] = maker.addAccessor(
        std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, 5126, "VEC4");
    maker.addNode({{"mesh", 0}, {"skin", 0}});
    maker.addNode(nlohmann::json::object());
    maker.addNode(nlohmann::json::object());
    maker.json["skins"] = {{{"joints", {1, 2}}}};
    animate(maker, {0, 0, 0, 0, 1, 0}, "VEC3", channel(2, "translation"));
    loadAtOrigin(maker);
    EXPECT_FALSE(isLit(draw(), 0.0, 1.0));
    const Pixels moved = drawAt(1.0);
    EXPECT_TRUE(isLit(moved, 0.0, 1.4));
    EXPECT_TRUE(isLit(moved, 0.0, -0.4));
    EXPECT_FALSE(isLit(moved, 0.0, -0.6));
    EXPECT_FALSE(isLit(drawAt(0.25), 0.0, 0.9));
}

TEST_F(PoseViewTest, AMorphAtWeightOneReachesItsTargetAndHalfTheWayAtAHalf) {
    GltfMaker maker = squareFile();
    const std::size_t deltas =
        maker.addAccessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0}, 5126, "VEC3");
    maker.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", deltas}}};
    maker.addNode({{"mesh", 0}});
    animate(maker, {0, 1}, "SCALAR", channel(0, "weights"));
    loadAtOrigin(maker);
    EXPECT_FALSE(isLit(draw(), 0.7, 0.0));
    const Pixels half = drawAt(0.5);
    EXPECT_TRUE(isLit(half, 0.9, 0.0));
    EXPECT_FALSE(isLit(half, 1.1, 0.0));
    const Pixels full = drawAt(1.0);
    EXPECT_TRUE(isLit(full, 1.4, 0.0));
    EXPECT_FALSE(isLit(full, 1.6, 0.0));
}

TEST_F(PoseViewTest, WeightsOfTheFileAreDrawnAtRest) {
    GltfMaker maker = squareFile();
    const std::size_t deltas =
        maker.addAccessor(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0}, 5126, "VEC3");
    maker.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", deltas}}};
    maker.json["meshes"][0]["weights"] = {1.0};
    maker.addNode({{"mesh", 0}});
    loadAtOrigin(maker);
    EXPECT_TRUE(isLit(draw(), 1.4, 0.0));
}

TEST_F(PoseViewTest, AnimatedNodesMoveTheirInstances) {
    GltfMaker maker = squareFile();
    maker.addNode({{"mesh", 0}});
    maker.addNode({{"mesh", 0}, {"translation", {0, -1.5, 0}}}); // stays
    animate(maker, {0, 0, 0, 0, 1, 0}, "VEC3", channel(0, "translation"));
    loadAtOrigin(maker);
    const Pixels moved = drawAt(1.0);
    EXPECT_TRUE(isLit(moved, 0.0, 1.3));
    EXPECT_FALSE(isLit(moved, 0.0, 0.0));
    EXPECT_TRUE(isLit(moved, 0.0, -1.5));
    EXPECT_EQ(report_.draw_calls, 1u); // instances of one primitive stay one call
}

TEST_F(PoseViewTest, WhatMovesFarIsNotCutOffByTheFarPlane) {
    GltfMaker maker = squareFile();
    maker.addNode({{"mesh", 0}});
    animate(maker, {0, 0, 0, 0, 0, -500}, "VEC3", channel(0, "translation"));
    loadAtOrigin(maker);
    input_.camera.scene_radius = 1.0;
    EXPECT_TRUE(isLit(drawAt(1.0), 0.0, 0.0));
}

TEST_F(PoseViewTest, AStillSceneIsDrawnOnce) {
    GltfMaker maker = squareFile();
    maker.addNode({{"mesh", 0}});
    animate(maker, {0, 0, 0, 0, 1, 0}, "VEC3", channel(0, "translation"));
    loadAtOrigin(maker);
    drawAt(0.5);
    const std::uint64_t revision = gpu_->revision();
    drawAt(0.5);
    EXPECT_EQ(gpu_->revision(), revision);
    EXPECT_FALSE(report_.drew);
}

} // namespace
} // namespace lodestone
