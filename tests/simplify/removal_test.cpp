#include "simplify/collapse/removal.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <numeric>
#include <random>
#include <set>

namespace lodestone {

namespace {

using meshes::submeshOf;

constexpr double kSide = 10.0; // of the square that instances are scattered over

ScenePtr scattered(int count) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> place(0.0, kSide);
    std::vector<glm::dmat4> transforms;
    for (int i = 0; i < count; ++i) {
        const double x = place(random);
        transforms.push_back(glm::translate(glm::dmat4(1.0), {x, place(random), 0.0}) *
                             glm::scale(glm::dmat4(1.0), glm::dvec3(0.05)));
    }
    return meshes::sceneOf({submeshOf({meshes::grid(2)})}, {transforms});
}

// Of the first submesh.
RemovalSequence planned(const ScenePtr& scene, const Bounds& bounds, const Cover& cover = {}) {
    const InstanceRange range = instanceRanges(*scene)[0];
    return planRemoval(
        *scene, range, factsOf(*scene, scene->submeshes[0], range.size()), bounds, cover);
}

RemovalSequence planned(const ScenePtr& scene) {
    return planned(scene, worldBounds(*scene));
}

// Variance over mean of how many of these instances lie in each of 25 cells, relative to all
// instances' own density: 1 for picks at random, 0 for perfectly even thinning.
double unevenness(const Scene& scene, std::span<const std::uint32_t> kept) {
    std::array<double, 25> count{};
    std::array<double, 25> all{};
    const auto cell_of = [&](std::uint32_t i) {
        const glm::dvec4 at = scene.instances[i].transform[3] * (5.0 / kSide);
        return static_cast<std::size_t>(std::min(at.x, 4.99)) +
               5 * static_cast<std::size_t>(std::min(at.y, 4.99));
    };
    for (const std::uint32_t i : kept)
        count[cell_of(i)] += 1.0;
    for (std::uint32_t i = 0; i < scene.instances.size(); ++i)
        all[cell_of(i)] += 1.0;
    const double share =
        static_cast<double>(kept.size()) / static_cast<double>(scene.instances.size());
    double sum = 0.0;
    for (std::size_t c = 0; c < count.size(); ++c) {
        const double expected = all[c] * share;
        sum += (count[c] - expected) * (count[c] - expected) / (expected * (1.0 - share));
    }
    return sum / 25.0;
}

LodSourcePtr prepared(const ScenePtr& scene) {
    return prepareEdgeCollapse(scene, {}, {}, {}).value();
}

} // namespace

TEST(Removal, OrderHoldsEveryInstanceOnce) {
    for (const int count : {2, 3, 7, 64, 1000}) {
        const RemovalSequence removal = planned(scattered(count));
        ASSERT_TRUE(removal.possible());
        const std::set<std::uint32_t> all(removal.order->begin(), removal.order->end());
        EXPECT_EQ(all.size(), static_cast<std::size_t>(count));
        EXPECT_EQ(*all.rbegin(), static_cast<std::uint32_t>(count - 1));
        EXPECT_EQ(removal.cost.size(), static_cast<std::size_t>(count - 1));
    }
}

TEST(Removal, KeptInstancesOfACoarserLodAreAmongThoseOfEveryFiner) {
    const LodSourcePtr source = prepared(scattered(300));
    std::set<std::uint32_t> finer;
    for (std::uint32_t i = 0; i < 300; ++i)
        finer.insert(i);
    for (std::uint64_t p = 0; p < source->positionCount(); ++p) {
        const Lod lod = source->readOut(p, nullptr);
        const std::vector<std::uint32_t>& order = *lod.submeshes[0].instance_order;
        const std::set<std::uint32_t> kept(
            order.begin(),
            order.begin() + static_cast<std::ptrdiff_t>(lod.submeshes[0].kept_instances));
        EXPECT_TRUE(std::ranges::includes(finer, kept)) << "position " << p;
        finer = kept;
    }
    EXPECT_EQ(finer.size(), 1u);
}

TEST(Removal, ThinsEvenlyAtEveryMoment) {
    const ScenePtr scene = scattered(2000);
    const RemovalSequence removal = planned(scene);
    std::vector<std::uint32_t> random(2000);
    std::iota(random.begin(), random.end(), 0u);
    std::ranges::shuffle(random, std::mt19937(9));
    for (const std::size_t kept : {1700, 1300, 1000, 800, 500, 350, 250}) {
        const std::span<const std::uint32_t> ours(removal.order->data(), kept);
        EXPECT_LT(unevenness(*scene, ours), 0.4 * unevenness(*scene, std::span(random).first(kept)))
            << kept << " kept";
    }
}

TEST(Removal, CostsRise) {
    const RemovalSequence removal = planned(scattered(500));
    EXPECT_TRUE(std::ranges::is_sorted(removal.cost));
    EXPECT_TRUE(std::ranges::is_sorted(removal.error));
    EXPECT_GT(removal.cost.front(), 0.0);
}

TEST(Removal, SurvivorsKeepTheAreaUntilTheyAreFourTimesAsLarge) {
    const ScenePtr scene = scattered(400);
    const RemovalSequence removal = planned(scene);
    for (std::uint32_t kept = 1; kept <= 400; ++kept) {
        const double growth = growthAt(removal, kept);
        EXPECT_LE(growth, kMaxGrowth);
        if (growth < kMaxGrowth) {
            EXPECT_NEAR(
                removal.area_left[kept] * growth * growth / removal.area_left[400], 1.0, 1e-6)
                << kept << " kept";
        } else {
            EXPECT_LE(kept, 400u / 16 + 1);
        }
    }
    EXPECT_EQ(growthAt(removal, 400), 1.0);
}

// Sheets of a third of the model's side: four times as large they would cover it.
TEST(Removal, GrowingMovesNoSurfaceFar) {
    std::vector<glm::dmat4> transforms;
    for (int i = 0; i < 100; ++i)
        transforms.push_back(glm::translate(glm::dmat4(1.0), {i % 10, i / 10, 0.0}) *
                             glm::scale(glm::dmat4(1.0), glm::dvec3(3.0)));
    const ScenePtr scene = meshes::sceneOf({submeshOf({meshes::grid(2)})}, {transforms});
    const double radius = 0.5 * 3.0 * std::sqrt(2.0);
    const double limit = 1.0 + kGrowthReach * worldBounds(*scene).diagonal() / radius;
    ASSERT_LT(limit, 2.0);
    const RemovalSequence removal = planned(scene);
    EXPECT_NEAR(growthAt(removal, 5), limit, 1e-4);
    EXPECT_NEAR(growthAt(removal, 95), std::sqrt(100.0 / 95.0), 1e-4);
}

TEST(Removal, ReadOutHasTheAreaOfTheWhole) {
    const ScenePtr scene = scattered(256);
    const LodSourcePtr source = prepared(scene);
    const auto area_at = [&](std::uint64_t position) {
        const LodSubmesh submesh = source->readOut(position, nullptr).submeshes[0];
        return meshes::shapeOf(submesh.primitives).area * submesh.kept_instances;
    };
    for (std::uint64_t p = 0; p < source->positionCount(); p += 5)
        if (source->shapeAt(p).submeshes[0].kept_instances >= 16) {
            EXPECT_NEAR(area_at(p), area_at(0), 1e-3 * area_at(0)) << "position " << p;
        }
}

TEST(Removal, TransformsOfSurvivorsNeverChange) {
    const ScenePtr scene = scattered(64);
    const LodSourcePtr source = prepared(scene);
    const Lod a = source->readOut(source->positionCount() - 1, nullptr);
    const Lod b = source->readOut(source->positionCount() / 2, nullptr);
    EXPECT_EQ(a.submeshes[0].instance_order, b.submeshes[0].instance_order);
    EXPECT_EQ(source->scene(), scene);
}

TEST(Removal, OfPairsTheOneThatWouldLeaveTheModelGoesFirst) {
    std::vector<glm::dmat4> transforms; // pairs: one at the model's border, one inside
    for (int i = 0; i < 8; ++i)
        for (const double x : {0.0, 0.6})
            transforms.push_back(glm::translate(glm::dmat4(1.0), {x, 10.0 * i, 0.0}) *
                                 glm::scale(glm::dmat4(1.0), {1.0, 1.0, 1.0}));
    const ScenePtr scene = meshes::sceneOf({submeshOf({meshes::grid(2)})}, {transforms});
    Bounds bounds = worldBounds(*scene);
    bounds.max += glm::dvec3(5.0);
    bounds.min -= glm::dvec3(0.0, 5.0, 5.0); // the wall is at x = 0
    const RemovalSequence removal = planned(scene, bounds);
    // Growing about their origin at x = 0 keeps all inside; about a centroid it does not.
    auto centred = std::make_shared<Geometry>(*meshes::moved(meshes::grid(2), {20.0, 0.0, 0.0}));
    for (glm::dmat4& transform : transforms)
        transform[3].x -= 20.0;
    const ScenePtr off = meshes::sceneOf({submeshOf({centred})}, {transforms});
    const RemovalSequence by_centroid = planned(off, bounds);
    EXPECT_NEAR(by_centroid.pivot.x, 20.5, 1e-6);
    EXPECT_EQ(removal.pivot, glm::dvec3(0.0));
    for (std::size_t k = 0; k < 8; ++k)
        EXPECT_EQ((*by_centroid.order)[k] % 2, 1u) << "the inner one of a pair survives";
}

TEST(Removal, DwarfsGoBeforeTheGiantsAmongThemWhichHardlyGrow) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> place(0.0, kSide);
    std::vector<glm::dmat4> transforms;
    for (int i = 0; i < 400; ++i) {
        const double x = place(random);
        const double size = i % 40 == 0 ? 1.0 : 0.02;
        transforms.push_back(glm::translate(glm::dmat4(1.0), {x, place(random), 0.0}) *
                             glm::scale(glm::dmat4(1.0), glm::dvec3(size)));
    }
    const RemovalSequence removal =
        planned(meshes::sceneOf({submeshOf({meshes::grid(2)})}, {transforms}));
    for (std::size_t k = 0; k < 10; ++k)
        EXPECT_EQ((*removal.order)[k] % 40, 0U) << k << ": a giant survives";
    EXPECT_TRUE(std::ranges::is_sorted(removal.cost));
    EXPECT_LE(growthAt(removal, 10), 1.01) << "ten giants have all of the area but a hundredth";
    EXPECT_GT(removal.cost[390], 100.0 * removal.cost[300]) << "giants are dear";
}

TEST(Removal, IsTheSameEveryTime) {
    const ScenePtr scene = scattered(500);
    EXPECT_EQ(*planned(scene).order, *planned(scene).order);
    EXPECT_EQ(planned(scene).cost, planned(scene).cost);
}

TEST(Removal, OfInstancesAtOnePlaceCostsNothing) {
    const std::vector<glm::dmat4> transforms(10, glm::dmat4(1.0));
    const RemovalSequence removal =
        planned(meshes::sceneOf({submeshOf({meshes::grid(2)})}, {transforms}));
    EXPECT_EQ(removal.cost, std::vector<double>(9, 0.0));
    EXPECT_EQ(growthAt(removal, 10), 1.0);
}

// Blades on a lawn, and the same blades in the air.
ScenePtr bladesOver(double height) {
    std::vector<glm::dmat4> blades;
    for (int x = 0; x < 20; ++x)
        for (int y = 0; y < 20; ++y)
            blades.push_back(glm::translate(glm::dmat4(1.0), {0.5 * x, 0.5 * y, height}) *
                             glm::scale(glm::dmat4(1.0), glm::dvec3(0.1)));
    return meshes::sceneOf({submeshOf({meshes::grid(2)}), submeshOf({meshes::grid(8)})},
                           {blades, {glm::scale(glm::dmat4(1.0), glm::dvec3(10.0))}});
}

std::vector<Cover> coversOf(const ScenePtr& scene) {
    std::vector<CollapseSequence> sequences;
    std::vector<SubmeshFacts> facts;
    const std::vector<InstanceRange> ranges = instanceRanges(*scene);
    for (std::size_t s = 0; s < ranges.size(); ++s) {
        sequences.push_back(meshes::sequenceOf(scene->submeshes[s]));
        facts.push_back(factsOf(*scene, scene->submeshes[s], ranges[s].size()));
    }
    return findCovers(*scene, ranges, facts, sequences, 1e-6);
}

TEST(Removal, WhatLiesOnALargerSurfaceIsCoveredByIt) {
    const std::vector<Cover> low = coversOf(bladesOver(0.01));
    EXPECT_NEAR(low[0].distance, 0.01, 1e-6);
    EXPECT_NEAR(low[0].cost_distance, 0.01, 1e-6); // of the same colour
    EXPECT_TRUE(std::isinf(low[1].distance)) << "nothing is larger than the lawn";
    EXPECT_TRUE(std::isinf(coversOf(bladesOver(1.0))[0].distance)) << "too far up";
}

TEST(Removal, AnotherColourIsMissedMore) {
    const ScenePtr scene = bladesOver(0.01);
    auto painted = std::make_shared<Scene>(*scene);
    painted->materials.resize(2);
    painted->materials[0].base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    painted->materials[1].base_color = glm::vec4(0.25f, 0.25f, 0.25f, 1.0f);
    painted->submeshes[0].primitives[0].material = 0;
    painted->submeshes[1].primitives[0].material = 1;
    const std::vector<Cover> covers = coversOf(painted);
    EXPECT_NEAR(covers[0].distance, 0.01, 1e-6);
    EXPECT_NEAR(covers[0].cost_distance, std::hypot(0.01, 0.25 * 0.1 * std::sqrt(0.5)), 1e-6);
}

TEST(Removal, ACoverMakesItCheaperAndKeepsSurvivorsFromOutgrowingIt) {
    const ScenePtr scene = bladesOver(0.01);
    const Bounds bounds = worldBounds(*scene);
    const RemovalSequence bare = planned(scene, bounds);
    const RemovalSequence covered = planned(scene, bounds, coversOf(scene)[0]);
    EXPECT_EQ(*bare.order, *covered.order);
    EXPECT_LT(covered.cost.front(), 0.01 * bare.cost.front());
    EXPECT_GT(covered.cost.back(), 10.0 * covered.cost.front()) << "the last ones stay dear";
    EXPECT_GT(growthAt(bare, 100), 1.9);
    EXPECT_LT(growthAt(covered, 100), 1.2);
    EXPECT_TRUE(std::ranges::is_sorted(covered.cost));
    EXPECT_TRUE(std::ranges::is_sorted(covered.growth));
}

TEST(Removal, OfAFewOfAKindEachCounts) {
    const RemovalSequence few = planned(scattered(4), {}, {1e-6, 1e-6});
    const RemovalSequence bare = planned(scattered(4), {});
    EXPECT_NEAR(few.cost.front(), 0.25 * bare.cost.front(), 1e-9);
}

TEST(Removal, MorphTargetsGrowWithTheirVertices) {
    auto geometry = std::make_shared<Geometry>(*meshes::grid(1));
    const std::vector<float> deltas(3 * geometry->positions.size(), 1.0f);
    geometry->morph_targets.push_back(
        {meshes::withAttribute(*geometry, "POSITION", deltas)->attributes});
    const Submesh submesh = submeshOf({geometry});
    const CollapseSequence sequence = meshes::sequenceOf(submesh);
    const GeometryPtr grown = readOutSubmesh(sequence, submesh, 0, 2.0, glm::dvec3(0.0))[0];
    EXPECT_EQ(grown->positions.back(), 2.0f * geometry->positions.back());
    EXPECT_EQ(attributeValue(grown->morph_targets[0].attributes[0], 0, 0), 2.0f);
}

} // namespace lodestone
