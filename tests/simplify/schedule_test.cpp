#include "scene/generate.h"
#include "simplify/measure/distance.h"
#include "tests/scene/scene_fixtures.h"
#include "tests/simplify/meshes.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

namespace lodestone {

namespace {

using meshes::submeshOf;

constexpr std::array kOrderings{Ordering::Triangle, Ordering::Byte, Ordering::Cost};

LodSourcePtr prepared(const ScenePtr& scene,
                      const ScheduleOptions& schedule = {},
                      const EdgeCollapseOptions& options = {}) {
    return prepareEdgeCollapse(scene, options, schedule, {}).value();
}

// Three submeshes of unlike size, count and scale.
ScenePtr mixedScene() {
    std::vector<glm::dmat4> many = meshes::gridOfTransforms(5, 3.0);
    for (std::size_t i = 0; i < many.size(); ++i)
        many[i] = many[i] * glm::scale(glm::dmat4(1.0), glm::dvec3(0.5 + 0.01 * double(i)));
    return meshes::sceneOf({submeshOf({meshes::sphere(8, 10)}),
                            submeshOf({meshes::torus(12, 8)}),
                            submeshOf({meshes::sphere(12, 16, 0.3), meshes::grid(6)})},
                           {many, {glm::dmat4(1.0)}, meshes::gridOfTransforms(2, 10.0)});
}

SequenceSet sequencesOf(const ScenePtr& scene) {
    SequenceSet set;
    set.scene = scene;
    set.ranges = instanceRanges(*scene);
    set.diagonal = worldBounds(*scene).diagonal();
    std::vector<SequenceRequest> requests(scene->submeshes.size());
    for (std::size_t s = 0; s < requests.size(); ++s) {
        requests[s].submesh = &scene->submeshes[s];
        requests[s].instance_count = set.ranges[s].size();
    }
    set.sequences = buildSequences(requests, {}, {}, {}).value();
    set.removals.resize(requests.size());
    set.max_stretch.assign(requests.size(), 1.0);
    return set;
}

std::uint64_t trianglesOf(const Lod& lod) {
    std::uint64_t triangles = 0;
    for (const LodSubmesh& submesh : lod.submeshes)
        for (const GeometryPtr& geometry : submesh.primitives)
            triangles += geometry->triangleCount() * submesh.kept_instances;
    return triangles;
}

} // namespace

TEST(Schedule, TrianglesNeverRiseAndEqualTheReadOut) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    for (const Ordering ordering : kOrderings) {
        const LodSourcePtr source = prepared(scene, {ordering, {}, {}});
        Lod lod = fullLod(*scene);
        for (std::uint64_t p = 0; p < source->positionCount(); ++p) {
            ASSERT_LE(source->trianglesAt(p), source->trianglesAt(p > 0 ? p - 1 : 0));
            lod = source->readOut(p, p > 0 ? &lod : nullptr);
            ASSERT_EQ(lod.triangles, source->trianglesAt(p));
            ASSERT_EQ(trianglesOf(lod), source->trianglesAt(p));
        }
    }
}

TEST(Schedule, ShapesEqualTheReadOut) {
    const ScenePtr scene = mixedScene();
    const LodSourcePtr source = prepared(scene);
    for (std::uint64_t p = 0; p < source->positionCount(); p += 11) {
        const LodShape predicted = source->shapeAt(p);
        const LodShape actual = shapeOf(*scene, source->readOut(p, nullptr));
        for (std::size_t s = 0; s < actual.submeshes.size(); ++s) {
            ASSERT_EQ(predicted.submeshes[s].kept_instances, actual.submeshes[s].kept_instances);
            ASSERT_EQ(predicted.submeshes[s].changed, actual.submeshes[s].changed);
            for (std::size_t i = 0; i < actual.submeshes[s].primitives.size(); ++i) {
                ASSERT_EQ(predicted.submeshes[s].primitives[i].vertices,
                          actual.submeshes[s].primitives[i].vertices);
                ASSERT_EQ(predicted.submeshes[s].primitives[i].indices,
                          actual.submeshes[s].primitives[i].indices);
            }
        }
    }
}

TEST(Schedule, PositionZeroIsTheScenesOwnGeometry) {
    const ScenePtr scene = mixedScene();
    const Lod lod = prepared(scene)->readOut(0, nullptr);
    for (std::size_t s = 0; s < scene->submeshes.size(); ++s)
        for (std::size_t p = 0; p < scene->submeshes[s].primitives.size(); ++p)
            EXPECT_EQ(lod.submeshes[s].primitives[p], scene->submeshes[s].primitives[p].geometry);
    EXPECT_EQ(lod.triangles, countScene(*scene).triangles);
}

TEST(Schedule, UnchangedSubmeshesShareTheirGeometryWithThePreviousLod) {
    const LodSourcePtr source = prepared(mixedScene());
    const Lod a = source->readOut(40, nullptr);
    const Lod b = source->readOut(41, &a);
    std::size_t shared = 0;
    for (std::size_t s = 0; s < a.submeshes.size(); ++s)
        shared += a.submeshes[s].primitives == b.submeshes[s].primitives ? 1 : 0;
    EXPECT_EQ(shared, a.submeshes.size() - 1); // one step, one submesh
}

TEST(Schedule, GoingUpGivesWhatGoingDownGave) {
    const LodSourcePtr source = prepared(mixedScene());
    const std::uint64_t last = source->positionCount() - 1;
    const Lod down = source->readOut(last / 2, nullptr);
    const Lod bottom = source->readOut(last, &down);
    const Lod up = source->readOut(last / 2, &bottom);
    for (std::size_t s = 0; s < up.submeshes.size(); ++s)
        for (std::size_t p = 0; p < up.submeshes[s].primitives.size(); ++p) {
            EXPECT_EQ(up.submeshes[s].primitives[p]->positions,
                      down.submeshes[s].primitives[p]->positions);
            EXPECT_EQ(up.submeshes[s].primitives[p]->indices,
                      down.submeshes[s].primitives[p]->indices);
        }
}

TEST(Schedule, ResolvesToTheFirstPositionAtOrBelowATarget) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    const LodSourcePtr source = prepared(scene);
    const auto full = static_cast<double>(source->trianglesAt(0));
    const auto bytes_at = [&](std::uint64_t position) {
        return static_cast<double>(bytes.bytes(source->shapeAt(position)));
    };
    for (const double ratio : {1.0, 0.999, 0.75, 0.5, 0.2, 0.1}) {
        const Resolved by_ratio = source->resolve({Target::Kind::Ratio, ratio}, bytes);
        ASSERT_TRUE(by_ratio.met) << ratio;
        EXPECT_TRUE(by_ratio.note.empty());
        EXPECT_LE(static_cast<double>(source->trianglesAt(by_ratio.position)), ratio * full);
        if (by_ratio.position > 0) {
            EXPECT_GT(static_cast<double>(source->trianglesAt(by_ratio.position - 1)),
                      ratio * full);
        }
        const double size = ratio * bytes_at(0);
        const Resolved by_size = source->resolve({Target::Kind::Bytes, size}, bytes);
        if (by_size.met && by_size.position > 0) {
            EXPECT_LE(bytes_at(by_size.position), size);
            EXPECT_GT(bytes_at(by_size.position - 1), size);
        }
    }
}

TEST(Schedule, AnErrorTargetIsNeverExceeded) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    const LodSourcePtr source = prepared(scene);
    for (const double error_percent : {0.0, 0.05, 0.5, 2.0}) {
        const Resolved resolved = source->resolve({Target::Kind::Error, error_percent}, bytes);
        EXPECT_LE(source->errorAt(resolved.position), error_percent);
        ASSERT_LT(resolved.position + 1, source->positionCount());
        EXPECT_GT(source->errorAt(resolved.position + 1), error_percent);
    }
}

TEST(Schedule, AMissedTargetEndsAtTheLastPositionAndSaysWhy) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    const LodSourcePtr source = prepared(scene);
    for (const Target target : {Target{Target::Kind::Ratio, 0.0},
                                Target{Target::Kind::Triangles, 3.0},
                                Target{Target::Kind::Bytes, 10.0}}) {
        const Resolved resolved = source->resolve(target, bytes);
        EXPECT_FALSE(resolved.met);
        EXPECT_EQ(resolved.position, source->positionCount() - 1);
        EXPECT_FALSE(resolved.note.empty());
    }
}

TEST(Schedule, ByCostItIsTheSingleGlobalQueueOfThePaper) {
    const ScenePtr scene = mixedScene();
    const SequenceSet set = sequencesOf(scene);
    const Schedule schedule(set, {Ordering::Cost, {}, {}}, nullptr);
    std::vector<std::uint32_t> step(set.sequences.size(), 0);
    for (std::uint64_t p = 1; p < schedule.positionCount(); ++p) {
        std::size_t cheapest = step.size(); // ties: the first submesh
        for (std::size_t s = 0; s < step.size(); ++s)
            if (step[s] < set.sequences[s].step_count &&
                (cheapest == step.size() ||
                 set.sequences[s].cost[step[s]] < set.sequences[cheapest].cost[step[cheapest]]))
                cheapest = s;
        ASSERT_LT(cheapest, step.size());
        ++step[cheapest];
        for (std::size_t s = 0; s < step.size(); ++s)
            ASSERT_EQ(schedule.stateAt(s, p).step, step[s]) << "position " << p;
    }
}

// Total cost spent to come down to a number of triangles.
double costAt(const SequenceSet& set, const Schedule& schedule, std::uint64_t triangles) {
    std::uint64_t position = 0;
    while (schedule.trianglesAt(position) > triangles)
        ++position;
    double cost = 0.0;
    for (std::size_t s = 0; s < set.sequences.size(); ++s)
        for (std::uint32_t i = 0; i < schedule.stateAt(s, position).step; ++i)
            cost += set.sequences[s].cost[i];
    return cost;
}

TEST(Schedule, PerTriangleSpendsLessCostThanByCostForTheSameTriangles) {
    const ScenePtr scene = mixedScene();
    const SequenceSet set = sequencesOf(scene);
    const ByteModel bytes(scene, {});
    const Schedule greedy(set, {Ordering::Triangle, {}, {}}, &bytes);
    const Schedule by_cost(set, {Ordering::Cost, {}, {}}, &bytes);
    const std::uint64_t full = greedy.trianglesAt(0);
    for (const std::uint64_t percent : {80, 60, 40, 20, 10})
        EXPECT_LE(costAt(set, greedy, full * percent / 100),
                  1.02 * costAt(set, by_cost, full * percent / 100))
            << percent << " %";
}

TEST(Schedule, ACheapRunBehindADearHeadIsPooledWithIt) {
    const ScenePtr scene =
        meshes::sceneOf({submeshOf({meshes::sphere(6, 8)}), submeshOf({meshes::sphere(6, 8)})},
                        {{glm::dmat4(1.0)}, {glm::dmat4(1.0)}});
    SequenceSet set = sequencesOf(scene);
    for (CollapseSequence& sequence : set.sequences)
        sequence.step_count = std::min(sequence.step_count, 10u);
    for (std::size_t i = 0; i < 10; ++i) {
        set.sequences[0].cost[i] = i == 0 ? 5.0 : 0.0; // 0.5 a step in the mean
        set.sequences[1].cost[i] = 1.0;
    }
    const Schedule schedule(set, {Ordering::Triangle, {}, {}}, nullptr);
    EXPECT_EQ(schedule.stateAt(0, 10).step, 10u);
    EXPECT_EQ(schedule.stateAt(1, 10).step, 0u);
    const Schedule by_cost(set, {Ordering::Cost, {}, {}}, nullptr);
    EXPECT_EQ(by_cost.stateAt(1, 10).step, 10u);
}

TEST(Schedule, ImportanceKeepsASubmeshLonger) {
    const ScenePtr scene =
        meshes::sceneOf({submeshOf({meshes::sphere(10, 12)}), submeshOf({meshes::sphere(10, 12)})},
                        {{glm::dmat4(1.0)}, {glm::dmat4(1.0)}});
    const ByteModel bytes(scene, {});
    for (const Ordering ordering : kOrderings) {
        const LodSourcePtr source = prepared(scene, {ordering, {1.0, 10.0}, {}});
        const std::uint64_t position = source->resolve({Target::Kind::Ratio, 0.5}, bytes).position;
        const LodShape shape = source->shapeAt(position);
        EXPECT_GT(shape.submeshes[1].primitives[0].indices,
                  2 * shape.submeshes[0].primitives[0].indices);
    }
}

TEST(Schedule, LockedSubmeshesAreNeverTouched) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    const LodSourcePtr source = prepared(scene, {Ordering::Triangle, {}, {true, false, false}});
    const Lod last = source->readOut(source->positionCount() - 1, nullptr);
    EXPECT_EQ(last.submeshes[0].primitives[0], scene->submeshes[0].primitives[0].geometry);
    EXPECT_EQ(last.submeshes[0].kept_instances, 25u);
    EXPECT_NE(last.submeshes[1].primitives[0], scene->submeshes[1].primitives[0].geometry);
    const Resolved missed = source->resolve({Target::Kind::Ratio, 0.01}, bytes);
    EXPECT_FALSE(missed.met);
    EXPECT_NE(missed.note.find("locked"), std::string::npos);
}

TEST(Schedule, ReschedulingEqualsPreparingAnew) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    for (const Ordering ordering : kOrderings) {
        const ScheduleOptions options{ordering, {2.0, 1.0, 0.5}, {false, false, true}};
        const LodSourcePtr again = prepared(scene)->rescheduled(options, bytes);
        const LodSourcePtr anew = prepared(scene, options);
        ASSERT_EQ(again->positionCount(), anew->positionCount());
        for (std::uint64_t p = 0; p < anew->positionCount(); ++p)
            ASSERT_EQ(again->trianglesAt(p), anew->trianglesAt(p));
    }
}

TEST(Schedule, OptionsMayBeShorterThanTheListOfSubmeshes) {
    const ScenePtr scene = mixedScene();
    const ByteModel bytes(scene, {});
    const LodSourcePtr few = prepared(scene, {Ordering::Triangle, {5.0}, {true}});
    const LodSourcePtr all =
        prepared(scene, {Ordering::Triangle, {5.0, 1.0, 1.0}, {true, false, false}});
    ASSERT_EQ(few->positionCount(), all->positionCount());
    for (std::uint64_t p = 0; p < all->positionCount(); ++p)
        ASSERT_EQ(few->trianglesAt(p), all->trianglesAt(p));
}

TEST(Schedule, PointsKeepAllTheirInstances) {
    Submesh points = submeshOf({meshes::grid(3)});
    points.primitives[0].mode = PrimitiveMode::Points;
    const ScenePtr scene = meshes::sceneOf({submeshOf({meshes::sphere(8, 10)}), points},
                                           {{glm::dmat4(1.0)}, meshes::gridOfTransforms(4, 2.0)});
    const LodSourcePtr source = prepared(scene);
    const Lod last = source->readOut(source->positionCount() - 1, nullptr);
    EXPECT_EQ(last.submeshes[1].kept_instances, 16u);
    EXPECT_EQ(last.submeshes[1].primitives[0], scene->submeshes[1].primitives[0].geometry);
}

TEST(Schedule, ASceneWithoutTrianglesHasOnePosition) {
    const ScenePtr scene = meshes::sceneOf({submeshOf({std::make_shared<Geometry>()})}, {{}});
    const LodSourcePtr source = prepared(scene);
    EXPECT_EQ(source->positionCount(), 1u);
    EXPECT_EQ(source->trianglesAt(0), 0u);
    EXPECT_TRUE(source->resolve({Target::Kind::Ratio, 0.5}, ByteModel(scene, {})).met);
}

TEST(Schedule, ErrorsRise) {
    const LodSourcePtr source = prepared(mixedScene());
    EXPECT_EQ(source->errorAt(0), 0.0);
    for (std::uint64_t p = 1; p < source->positionCount(); ++p)
        ASSERT_GE(source->errorAt(p), source->errorAt(p - 1));
    EXPECT_LT(source->errorAt(source->positionCount() - 1), 200.0);
}

// Removal of instances takes over where collapsing ends.
TEST(Schedule, ReachesATenthOfAPercentOnScenesOfManyInstances) {
    for (const std::string_view name : {"maple", "chair"}) {
        const ScenePtr scene = generateScene(name).value();
        const ByteModel bytes(scene, {});
        const LodSourcePtr source = prepared(scene);
        const double ratio = name == "maple" ? 0.001 : 0.05;
        const Resolved resolved = source->resolve({Target::Kind::Ratio, ratio}, bytes);
        EXPECT_TRUE(resolved.met) << name;
        EXPECT_LE(static_cast<double>(source->trianglesAt(resolved.position)),
                  ratio * static_cast<double>(source->trianglesAt(0)));
    }
}

// A crowd of spheres, two tori.
TEST(Schedule, ByThePapersRuleOnlyCrowdsAreThinnedOnceNothingIsLeftToCollapse) {
    const ScenePtr scene =
        meshes::sceneOf({submeshOf({meshes::sphere(8, 10)}), submeshOf({meshes::torus(12, 8)})},
                        {meshes::gridOfTransforms(7, 3.0),
                         {glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), glm::dvec3(-9.0))}});
    EdgeCollapseOptions options;
    options.remove_by_paper = true;
    for (const Ordering ordering : kOrderings) {
        const LodSourcePtr source = prepared(scene, {ordering, {}, {}}, options);
        const Lod last = source->readOut(source->positionCount() - 1, nullptr);
        EXPECT_EQ(last.submeshes[0].kept_instances, 1u);
        EXPECT_EQ(last.submeshes[1].kept_instances, 2u);
        std::uint64_t first = 0; // position with an instance less
        while (source->shapeAt(first).submeshes[0].kept_instances == 49)
            ++first;
        EXPECT_EQ(source->readOut(first, nullptr).unique_triangles, last.unique_triangles);
        EXPECT_EQ(source->positionCount() - first, 48u);
    }
}

double areaOf(const Lod& lod, std::size_t submesh) {
    return meshes::shapeOf(lod.submeshes[submesh].primitives).area *
           lod.submeshes[submesh].kept_instances;
}

// The original code thins out leaves only after it has destroyed the trunk, and misses the target.
TEST(Schedule, AForestOfCardsKeepsItsTrunkAndTheAreaOfItsLeaves) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> even(-1.0, 1.0);
    std::vector<glm::dmat4> leaves;
    while (leaves.size() < 40'000) {
        const glm::dvec3 at(even(random), even(random), even(random));
        if (glm::dot(at, at) > 1.0)
            continue;
        const glm::dvec3 axis(even(random), even(random), 1.1);
        leaves.push_back(glm::rotate(glm::translate(glm::dmat4(1.0), 4.0 * at),
                                     3.0 * even(random),
                                     glm::normalize(axis)) *
                         glm::scale(glm::dmat4(1.0), glm::dvec3(0.1)));
    }
    const glm::dmat4 stem = glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, -3.0)),
                                       glm::dvec3(0.4, 0.4, 5.0));
    const Submesh trunk = submeshOf({meshes::sphere(25, 40)});
    const ScenePtr scene = meshes::sceneOf({trunk, submeshOf({meshes::card(1)})}, {{stem}, leaves});
    const ScenePtr alone = meshes::sceneOf({trunk}, {{stem}});
    const LodSourcePtr source = prepared(scene);
    const Lod whole = source->readOut(0, nullptr);
    for (const double ratio : {0.2, 0.05}) {
        const double target = ratio * static_cast<double>(whole.triangles);
        const Resolved at = source->resolve({Target::Kind::Triangles, target}, {scene, {}});
        const Lod lod = source->readOut(at.position, nullptr);
        EXPECT_TRUE(at.met);
        EXPECT_GE(static_cast<double>(lod.triangles), 0.99 * target);
        EXPECT_NEAR(areaOf(lod, 1), areaOf(whole, 1), 0.05 * areaOf(whole, 1)) << ratio;
        Lod of_trunk;
        of_trunk.submeshes.push_back(lod.submeshes[0]);
        of_trunk.submeshes[0].instance_order = nullptr;
        const Lod full = fullLod(*alone);
        const auto distance =
            measureDistance({alone.get(), &full}, {alone.get(), &of_trunk}, {20'000, 1}, {});
        ASSERT_TRUE(distance.has_value());
        EXPECT_LE(distance->hausdorff, 1.0) << ratio;
    }
}

} // namespace lodestone
