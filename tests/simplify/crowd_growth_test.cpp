#include "simplify/collapse/crowd_growth.h"
#include "simplify/wild/wild.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

// Cards of two triangles in a block, each at its own place and facing its own way.
GeometryPtr leaves(int per_side) {
    auto all = std::make_shared<Geometry>();
    for (int i = 0; i < per_side * per_side * per_side; ++i) {
        const glm::vec3 at(i % per_side, i / per_side % per_side, i / per_side / per_side);
        const float turn = 0.7f * static_cast<float>(i);
        const glm::vec3 along(0.1f * std::cos(turn), 0.1f * std::sin(turn), 0.05f);
        const glm::vec3 across(0.1f * std::sin(turn), -0.1f * std::cos(turn), 0.08f);
        const auto first = static_cast<std::uint32_t>(all->positions.size());
        for (const glm::vec3& corner :
             {-along - across, along - across, along + across, across - along})
            all->positions.push_back(at + corner);
        for (const std::uint32_t index : {0u, 1u, 2u, 0u, 2u, 3u})
            all->indices.push_back(first + index);
    }
    return all;
}

double areaAt(const ScenePtr& scene, double ratio, bool crowds) {
    const ParameterValues values{{"crowds", crowds ? 1.0 : 0.0}, {"floors", 0.0}};
    const LodSourcePtr source = wildAlgorithm().prepare(scene, values, {}, {}).value();
    const ByteModel bytes(source->scene(), {});
    const Lod lod =
        source->readOut(source->resolve({Target::Kind::Ratio, ratio}, bytes).position, nullptr);
    double area = 0.0;
    for (const LodSubmesh& submesh : lod.submeshes)
        area += meshes::shapeOf(submesh.primitives).area;
    return area;
}

} // namespace

TEST(CrowdGrowth, LeavesThatAreLeftCoverAsMuchAsAllDid) {
    const ScenePtr scene = meshes::sceneOf({meshes::submeshOf({leaves(8)})}, {{glm::dmat4(1.0)}});
    const double all = areaAt(scene, 1.0, true);
    EXPECT_LT(areaAt(scene, 0.1, false), 0.3 * all); // what it is there for
    for (const double ratio : {0.5, 0.2, 0.1, 0.05})
        EXPECT_NEAR(areaAt(scene, ratio, true), all, 0.1 * all) << ratio;
}

TEST(CrowdGrowth, NoLeafGrowsBeyondHalfOfItsCrowd) {
    const ScenePtr scene = meshes::sceneOf({meshes::submeshOf({leaves(8)})}, {{glm::dmat4(1.0)}});
    const LodSourcePtr source = wildAlgorithm().prepare(scene, {{"floors", 0.0}}, {}, {}).value();
    const Lod last = source->readOut(source->positionCount() - 2, nullptr);
    const Bounds whole = localBounds(scene->submeshes[0]);
    Bounds left;
    for (const GeometryPtr& geometry : last.submeshes[0].primitives)
        for (const std::uint32_t index : geometry->indices)
            left.add(glm::dvec3(geometry->positions[index]));
    ASSERT_FALSE(left.empty);
    EXPECT_LE(left.diagonal(), 0.52 * whole.diagonal());
}

TEST(CrowdGrowth, NeitherDoesOneThatIsLargerThanTheOthers) {
    Geometry all = *leaves(4);
    const std::size_t first = all.positions.size() - 4;
    const glm::vec3 middle = 0.5f * (all.positions[first] + all.positions[first + 2]);
    for (std::size_t i = first; i < all.positions.size(); ++i) // still less than 16 x the area
        all.positions[i] = middle + (all.positions[i] - middle) * 3.5f;
    const Submesh submesh = meshes::submeshOf({std::make_shared<const Geometry>(all)});
    const CollapseSequence sequence = meshes::sequenceOf(submesh);
    const CrowdGrowth growth = growCrowds(sequence, submesh);
    ASSERT_EQ(growth.pivots.size(), 64u); // it is one of them
    Bounds whole;
    Bounds grown;
    for (std::uint32_t wedge = 0; wedge < all.positions.size(); ++wedge) {
        whole.add(glm::dvec3(all.positions[wedge]));
        if (wedge >= first)
            grown.add(
                glm::dvec3(growth.grown(0, wedge, sequence.recordedSteps(), all.positions[wedge])));
    }
    EXPECT_LE(grown.diagonal(), 0.501 * whole.diagonal());
}

TEST(CrowdGrowth, ClosedPartsAndFewPartsAreNoCrowd) {
    std::vector<GeometryPtr> closed;
    for (int i = 0; i < 64; ++i)
        closed.push_back(meshes::moved(meshes::sphere(3, 4), {3.0 * i, 0.0, 0.0}));
    auto all = std::make_shared<Geometry>();
    for (const GeometryPtr& part : closed) {
        const auto first = static_cast<std::uint32_t>(all->positions.size());
        all->positions.insert(all->positions.end(), part->positions.begin(), part->positions.end());
        for (const std::uint32_t index : part->indices)
            all->indices.push_back(first + index);
    }
    for (const GeometryPtr& geometry : {GeometryPtr(all), leaves(3)}) {
        const Submesh submesh = meshes::submeshOf({geometry});
        const CollapseSequence sequence = meshes::sequenceOf(submesh);
        EXPECT_TRUE(growCrowds(sequence, submesh).part_of_wedge.empty());
    }
}

TEST(CrowdGrowth, LeavesWithTwoSidesAreACrowdToo) {
    Geometry both = *leaves(4);
    const std::vector<std::uint32_t> front = both.indices;
    for (std::size_t i = 0; i < front.size(); i += 3)
        both.indices.insert(both.indices.end(), {front[i], front[i + 2], front[i + 1]});
    const Submesh submesh = meshes::submeshOf({std::make_shared<const Geometry>(both)});
    EXPECT_EQ(growCrowds(meshes::sequenceOf(submesh), submesh).pivots.size(), 64u);
}

TEST(CrowdGrowth, GrowsMoreTheCoarserTheStep) {
    const Submesh submesh = meshes::submeshOf({leaves(6)});
    const CollapseSequence sequence = meshes::sequenceOf(submesh);
    const CrowdGrowth growth = growCrowds(sequence, submesh);
    ASSERT_EQ(growth.factors.size(), 1u);
    ASSERT_EQ(growth.factors[0].size(), sequence.recordedSteps() + 1u);
    EXPECT_EQ(growth.factors[0].front(), 1.0f);
    EXPECT_GT(growth.factors[0].back(), 1.5f);
    EXPECT_TRUE(std::ranges::is_sorted(growth.factors[0]));
}

} // namespace lodestone
