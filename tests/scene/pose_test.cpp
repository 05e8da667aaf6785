#include "scene/pose.h"
#include "tests/scene/gltf_maker.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

using namespace tests;

constexpr double kTiny = 1e-6;

// A node that one channel moves.
Rig rigOf(const AnimationChannel& channel) {
    Rig rig;
    rig.nodes.emplace_back();
    rig.nodes[0].weights.assign(2, 0.0f);
    rig.order = {0};
    rig.animations.push_back({"", static_cast<double>(channel.times_s.back()), {channel}});
    return rig;
}

glm::dvec3 placeAt(const Rig& rig, double time_s) {
    return {poseAt(rig, {0, time_s}).worlds[0][3]};
}

void expectNear(const glm::dvec3& found, const glm::dvec3& wanted) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], wanted[c], kTiny) << "component " << c;
}

TEST(Pose, LinearKeysAreMixedAndHoldOutsideTheirTime) {
    const Rig rig = rigOf({0,
                           AnimatedPath::Translation,
                           Interpolation::Linear,
                           3,
                           {1.0f, 3.0f},
                           {0, 0, 0, 4, 8, -2}});
    expectNear(placeAt(rig, 1.5), {1, 2, -0.5});
    expectNear(placeAt(rig, 0.0), {0, 0, 0});
    expectNear(placeAt(rig, 3.0), {4, 8, -2});
    expectNear(placeAt(rig, 99.0), {4, 8, -2});
}

TEST(Pose, StepKeysHoldUntilTheNext) {
    const Rig rig = rigOf(
        {0, AnimatedPath::Translation, Interpolation::Step, 3, {0.0f, 1.0f}, {1, 0, 0, 2, 0, 0}});
    expectNear(placeAt(rig, 0.999), {1, 0, 0});
    expectNear(placeAt(rig, 1.0), {2, 0, 0});
}

TEST(Pose, CubicSplineIsHermiteWithTangentsTimesTheSpan) {
    // x(t) = t^3 on 0..2: values 0, 8, tangents 0, 12.
    const Rig rig = rigOf({0,
                           AnimatedPath::Translation,
                           Interpolation::CubicSpline,
                           3,
                           {0.0f, 2.0f},
                           {0, 0, 0, 0, 0, 0, 0, 0, 0, 12, 0, 0, 8, 0, 0, 12, 0, 0}});
    for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0})
        expectNear(placeAt(rig, t), {t * t * t, 0, 0});
}

TEST(Pose, RotationsTakeTheShorterArcAtConstantSpeed) {
    const auto half = static_cast<float>(std::sqrt(0.5));
    // A quarter turn about z, its end given by the other of the two quaternions.
    const Rig rig = rigOf({0,
                           AnimatedPath::Rotation,
                           Interpolation::Linear,
                           4,
                           {0.0f, 1.0f},
                           {0, 0, 0, 1, 0, 0, -half, -half}});
    const double angle = std::numbers::pi / 2.0 / 3.0;
    const glm::dmat4 third = poseAt(rig, {0, 1.0 / 3.0}).worlds[0];
    expectNear(glm::dvec3(third * glm::dvec4(1, 0, 0, 0)), {std::cos(angle), std::sin(angle), 0});
}

TEST(Pose, WeightsAreAnimatedTogether) {
    const Rig rig =
        rigOf({0, AnimatedPath::Weights, Interpolation::Linear, 2, {0.0f, 1.0f}, {0, 1, 1, 0}});
    const Pose pose = poseAt(rig, {0, 0.25});
    EXPECT_FLOAT_EQ(pose.weights[0][0], 0.25f);
    EXPECT_FLOAT_EQ(pose.weights[0][1], 0.75f);
    EXPECT_FLOAT_EQ(poseAt(rig, {}).weights[0][1], 0.0f);
}

// A triangle whose vertices hang on two joints, the second below the first.
GltfMaker skinnedTriangle() {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    auto& attributes = maker.json["meshes"][mesh]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = maker.addAccessor(
        std::vector<std::uint16_t>{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5123, "VEC4");
    attributes["WEIGHTS_0"] = maker.addAccessor(
        std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, 5126, "VEC4");
    // The mesh's own place does not count where it has a skin.
    maker.addNode({{"mesh", mesh}, {"skin", 0}, {"translation", {100, 0, 0}}});
    maker.addNode({{"children", {2}}});
    maker.addNode({{"translation", {0, 0, 1}}}, false);
    // MAT4 accessors are named by their type's digit as if they had 4 components.
    const std::size_t inverse =
        maker.addAccessor(std::vector<float>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0,  1,
                                             1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1},
                          5126,
                          "VEC4");
    maker.json["accessors"][inverse]["type"] = "MAT4";
    maker.json["accessors"][inverse]["count"] = 2;
    maker.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
    const std::size_t times = maker.addAccessor(std::vector<float>{0, 1}, 5126, "SCALAR");
    const std::size_t places =
        maker.addAccessor(std::vector<float>{0, 0, 1, 0, 4, 1}, 5126, "VEC3");
    maker.json["animations"] = {
        {{"name", "up"},
         {"samplers", {{{"input", times}, {"output", places}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}}};
    return maker;
}

TEST(Pose, SkinnedVerticesGoWithTheirJoints) {
    const ScenePtr scene = skinnedTriangle().scene();
    const RigPtr rig = readRig(*scene);
    ASSERT_EQ(rig->animations.size(), 1u) << (rig->notes.empty() ? "" : rig->notes[0]);
    EXPECT_EQ(rig->animations[0].name, "up");
    EXPECT_DOUBLE_EQ(rig->animations[0].duration_s, 1.0);
    const Pose rest = poseAt(*rig, {});
    for (const double time : {0.0, 0.5, 1.0}) {
        const Pose pose = poseAt(*rig, {0, time});
        const InstancePose instance = instancePose(*scene, *rig, rest, pose, 0);
        ASSERT_EQ(instance.skin, 0u);
        const std::vector<glm::dvec3> positions = posedPositions(
            *scene->submeshes[0].primitives[0].geometry, instance, jointMatrices(*rig, pose, 0));
        expectNear(positions[0], {0, 0, 0});
        expectNear(positions[1], {1, 4.0 * time, 0});
        expectNear(positions[2], {0, 1.0 + 2.0 * time, 0});
    }
}

TEST(Pose, ChannelsThatCannotBePlayedAreNamedAndLeftAtRest) {
    GltfMaker maker = skinnedTriangle();
    maker.json["animations"][0]["channels"].push_back(
        {{"sampler", 7}, {"target", {{"node", 1}, {"path", "scale"}}}});
    maker.json["animations"][0]["channels"].push_back(
        {{"sampler", 0}, {"target", {{"node", 1}, {"path", "rotation"}}}}); // three numbers a key
    const RigPtr rig = readRig(*maker.scene());
    EXPECT_EQ(rig->animations[0].channels.size(), 1u);
    ASSERT_EQ(rig->notes.size(), 1u);
    EXPECT_NE(rig->notes[0].find("2 of 3 channels"), std::string::npos) << rig->notes[0];
}

TEST(Pose, AMorphAtWeightOneReachesItsTarget) {
    Geometry geometry;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Attribute deltas;
    deltas.semantic = "POSITION";
    const std::vector<float> values{0, 0, 2, 0, 0, 4, 0, 0, 6};
    deltas.bytes.resize(values.size() * sizeof(float));
    std::memcpy(deltas.bytes.data(), values.data(), deltas.bytes.size());
    geometry.morph_targets.push_back({{deltas}});
    const std::vector<float> weights{1.0f};
    InstancePose instance;
    instance.weights = weights;
    instance.transform[3] = {10, 0, 0, 1};
    const std::vector<glm::dvec3> positions = posedPositions(geometry, instance, {});
    expectNear(positions[0], {10, 0, 2});
    expectNear(positions[1], {11, 0, 4});
    expectNear(positions[2], {10, 1, 6});
}

TEST(Pose, WhatDoesNotMoveKeepsItsTransformToTheBit) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"mesh", mesh}, {"rotation", {0.1, 0.2, 0.3, 0.9}}, {"scale", {3, 0.1, 7}}});
    const ScenePtr scene = maker.scene();
    const RigPtr rig = readRig(*scene);
    const Pose rest = poseAt(*rig, {});
    const InstancePose instance = instancePose(*scene, *rig, rest, rest, 0);
    EXPECT_FALSE(instance.moved);
    EXPECT_EQ(instance.transform, scene->instances[0].transform);
}

TEST(Pose, AnimatedParentsCarryTheirChildren) {
    GltfMaker maker;
    const std::size_t mesh = maker.addTriangle();
    maker.addNode({{"children", {1}}});
    maker.addNode({{"mesh", mesh}, {"translation", {1, 0, 0}}}, false);
    const std::size_t times = maker.addAccessor(std::vector<float>{0, 1}, 5126, "SCALAR");
    const std::size_t sizes = maker.addAccessor(std::vector<float>{1, 1, 1, 3, 3, 3}, 5126, "VEC3");
    maker.json["animations"] = {
        {{"samplers", {{{"input", times}, {"output", sizes}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "scale"}}}}}}}};
    const ScenePtr scene = maker.scene();
    const RigPtr rig = readRig(*scene);
    const Bounds bounds = posedBounds(*scene, fullLod(*scene), *rig, {0, 1.0});
    expectNear(bounds.min, {3, 0, 0});
    expectNear(bounds.max, {6, 3, 0});
}

} // namespace
} // namespace lodestone
