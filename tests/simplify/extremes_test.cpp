#include "simplify/collapse/extremes.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace lodestone {
namespace {

using meshes::sphere;
using meshes::submeshOf;
using meshes::withAttribute;

// Of two joints: the first holds what lies below, the second what lies above.
GeometryPtr limb() {
    const GeometryPtr body = sphere(30, 40);
    std::vector<float> joints;
    std::vector<float> weights;
    for (const glm::vec3& p : body->positions) {
        const float above = std::clamp(0.5f + 2.0f * p.z, 0.0f, 1.0f);
        joints.insert(joints.end(), {0.0f, 1.0f, 0.0f, 0.0f});
        weights.insert(weights.end(), {1.0f - above, above, 0.0f, 0.0f});
    }
    return withAttribute(*withAttribute(*body, "JOINTS_0", joints), "WEIGHTS_0", weights);
}

// The upper half swings about the middle.
std::vector<Posture> swings(int count) {
    std::vector<Posture> postures;
    for (int k = 0; k < count; ++k) {
        const float angle = 1.5f * static_cast<float>(k) / static_cast<float>(count);
        const glm::mat4 turned = glm::rotate(glm::mat4(1.0f), angle, glm::vec3(0.0f, 1.0f, 0.0f));
        postures.push_back(
            {glm::mat4(1.0f),
             std::make_shared<const std::vector<glm::mat4>>(std::vector{glm::mat4(1.0f), turned}),
             {}});
    }
    return postures;
}

// Where a vertex of limb() stands; as its definition has it.
glm::dvec3 placeOf(const glm::vec3& p, const Posture& posture) {
    const double above = std::clamp(0.5 + 2.0 * static_cast<double>(p.z), 0.0, 1.0);
    const glm::dvec4 at(glm::dvec3(p), 1.0);
    return glm::dvec3(glm::mix(glm::dvec4(glm::dmat4((*posture.joints)[0]) * at),
                               glm::dvec4(glm::dmat4((*posture.joints)[1]) * at),
                               above));
}

template <class Places>
Bounds boxOf(const Places& places, const Posture& posture) {
    Bounds box;
    for (const glm::vec3& p : places)
        box.add(placeOf(p, posture));
    return box;
}

// The largest way between the same sides of two boxes, in diagonals of the first.
double apart(const Bounds& a, const Bounds& b) {
    const glm::dvec3 worst = glm::max(glm::abs(a.min - b.min), glm::abs(a.max - b.max));
    return std::max({worst.x, worst.y, worst.z}) / a.diagonal();
}

double worstApart(std::span<const glm::vec3> all,
                  std::span<const glm::vec3> few,
                  std::span<const Posture> postures) {
    double worst = 0.0;
    for (const Posture& posture : postures)
        worst = std::max(worst, apart(boxOf(all, posture), boxOf(few, posture)));
    return worst;
}

struct Chosen {
    Complex complex;
    std::vector<glm::vec3> places;
};

Chosen choose(const Submesh& submesh, std::span<const Posture> postures) {
    Chosen chosen{buildComplex(submesh, {}), {}};
    const WedgeAttributes attributes = gatherAttributes(submesh, chosen.complex);
    for (const std::uint32_t v : extremeVertices(chosen.complex, attributes, postures))
        chosen.places.push_back(chosen.complex.positions[v]);
    return chosen;
}

// The limb with few triangles left.
std::vector<glm::vec3> collapsed(const Submesh& submesh, const std::vector<Posture>& postures) {
    SequenceRequest request;
    request.submesh = &submesh;
    request.postures = postures;
    const auto sequences = buildSequences(std::span(&request, 1), {}, {}, {});
    const CollapseSequence& sequence = sequences.value()[0];
    std::uint32_t step = 0;
    while (step < sequence.step_count && sequence.facesAt(step) > 60)
        ++step;
    return meshes::readAt(sequence, submesh, step)[0]->positions;
}

TEST(Extremes, ReachEverySideOfTheBoxInEveryPosture) {
    const std::vector<Posture> postures = swings(9);
    const Chosen chosen = choose(submeshOf({limb()}), postures);
    EXPECT_LE(worstApart(chosen.complex.positions, chosen.places, postures), 0.0026);
    EXPECT_LE(chosen.places.size(), 6 * postures.size());
}

TEST(Extremes, AreNoMoreForTheSamePostureAgain) {
    const Submesh submesh = submeshOf({limb()});
    std::vector<Posture> postures = swings(1);
    const std::vector<glm::vec3> once = choose(submesh, postures).places;
    postures.resize(20, postures[0]);
    EXPECT_EQ(choose(submesh, postures).places, once);
    EXPECT_GE(once.size(), 2u);
    EXPECT_LE(once.size(), 6u);
}

TEST(Extremes, AreNoneWithoutPostures) {
    EXPECT_TRUE(choose(submeshOf({limb()}), {}).places.empty());
}

TEST(Extremes, NonsenseOfTheFileChoosesNone) {
    std::vector<Posture> postures = swings(1);
    postures[0].joints = std::make_shared<const std::vector<glm::mat4>>(
        std::vector{glm::mat4(std::numeric_limits<float>::quiet_NaN())});
    EXPECT_TRUE(choose(submeshOf({limb()}), postures).places.empty());
}

TEST(Extremes, HoldTheBoxOfAMovingSubmeshWhileItCollapses) {
    const Submesh submesh = submeshOf({limb()});
    const std::vector<Posture> postures = swings(9);
    const std::vector<glm::vec3>& all = submesh.primitives[0].geometry->positions;
    EXPECT_LE(worstApart(all, collapsed(submesh, postures), postures), 0.01);
    EXPECT_GT(worstApart(all, collapsed(submesh, {}), postures), 0.01);
}

TEST(Extremes, OnlyWhatDeformsHasPostures) {
    const auto none =
        deformingPostures(*meshes::sceneOf({submeshOf({sphere(6, 8)})}, {{glm::dmat4(1.0)}}));
    ASSERT_EQ(none.size(), 1u);
    EXPECT_TRUE(none[0].empty());
    const auto skinned =
        deformingPostures(*meshes::sceneOf({submeshOf({limb()})}, {{glm::dmat4(1.0)}}));
    ASSERT_EQ(skinned.size(), 1u);
    EXPECT_EQ(skinned[0].size(), 1u); // at rest: no file, no animations
}

} // namespace
} // namespace lodestone
