#include "tests/simplify/meshes.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

using meshes::readAt;
using meshes::sequenceOf;
using meshes::Shape;
using meshes::submeshOf;

constexpr FloorOptions kNoFloors{false, 0, 0.0};

GeometryPtr made(std::vector<glm::vec3> positions, std::vector<std::uint32_t> indices) {
    auto geometry = std::make_shared<Geometry>();
    geometry->positions = std::move(positions);
    geometry->indices = std::move(indices);
    return geometry;
}

GeometryPtr joined(const Geometry& a, const Geometry& b) {
    auto both = std::make_shared<Geometry>(a);
    const auto first = static_cast<std::uint32_t>(a.positions.size());
    both->positions.insert(both->positions.end(), b.positions.begin(), b.positions.end());
    for (const std::uint32_t index : b.indices)
        both->indices.push_back(first + index);
    return both;
}

// A grid with hills, open.
GeometryPtr hills(int quads_per_side) {
    auto geometry = std::make_shared<Geometry>(*meshes::grid(quads_per_side));
    for (glm::vec3& p : geometry->positions)
        p.z = 0.1f * std::sin(9.0f * p.x) * std::cos(7.0f * p.y);
    return geometry;
}

// Turned faces (cosine below `cosine`) among those alive at both steps.
std::uint32_t turnedFaces(const CollapseSequence& sequence,
                          const Submesh& submesh,
                          std::uint32_t step,
                          double cosine) {
    const Complex& complex = sequence.complex;
    std::vector<std::uint32_t> before(complex.wedge_source.size());
    std::vector<std::uint32_t> after(before.size());
    resolveWedges(sequence, step - 1, before);
    resolveWedges(sequence, step, after);
    const auto normal = [&](const auto& face, const auto& stands_for, std::uint32_t at) {
        std::array<glm::dvec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = glm::dvec3(wedgePosition(sequence, submesh, stands_for[face[k]], at));
        return glm::cross(p[1] - p[0], p[2] - p[0]);
    };
    std::uint32_t turned = 0;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (sequence.face_death[f] <= step)
            continue;
        const glm::dvec3 m = normal(complex.faces[f], before, step - 1);
        const glm::dvec3 n = normal(complex.faces[f], after, step);
        const double length = glm::length(m) * glm::length(n);
        turned += length > 0.0 && glm::dot(m, n) < (cosine - 1e-3) * length ? 1 : 0;
    }
    return turned;
}

void expectClosedManifold(const Submesh& submesh, std::uint32_t down_to) {
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step) {
        if (sequence.facesAt(step) < down_to)
            break;
        const Shape shape = meshes::shapeOf(readAt(sequence, submesh, step));
        ASSERT_EQ(shape.border_edges, 0u) << "step " << step << ", " << shape.faces << " faces";
        ASSERT_EQ(shape.non_manifold_edges, 0u) << "step " << step << ", " << shape.faces;
        ASSERT_EQ(shape.degenerate_faces, 0u) << "step " << step;
    }
    EXPECT_LE(sequence.facesAt(sequence.step_count), down_to);
}

} // namespace

TEST(Collapse, ClosedMeshesStayClosedManifoldsDownToATetrahedron) {
    expectClosedManifold(submeshOf({meshes::sphere(12, 16)}), 4);
    expectClosedManifold(submeshOf({meshes::sphere(5, 5, 0.0)}), 4);
}

TEST(Collapse, ATorusStaysAClosedManifoldNearlyToTheSmallestThereIs) {
    expectClosedManifold(submeshOf({meshes::torus(14, 8)}), 18);
}

// A finer mesh starts with the near-greedy passes.
TEST(Collapse, NearGreedyPassesKeepClosedMeshesClosed) {
    const Submesh submesh = submeshOf({meshes::sphere(40, 60)});
    CollapseOptions options;
    options.near_greedy_above = 1000;
    options.exact_below = 300;
    const CollapseSequence sequence = sequenceOf(submesh, options);
    for (std::uint32_t step = 0; step <= sequence.step_count; step += 37) {
        const Shape shape = meshes::shapeOf(readAt(sequence, submesh, step));
        ASSERT_EQ(shape.border_edges, 0u) << "step " << step;
        ASSERT_EQ(shape.non_manifold_edges, 0u) << "step " << step;
    }
    EXPECT_EQ(sequence.facesAt(sequence.step_count), 4u);
}

// Passes go through a mesh as large as this part by part; their steps are in the order of costs.
TEST(Collapse, EveryStepOfALargeMeshIsSoundAndAsCoarseOnBothSides) {
    const Submesh submesh = submeshOf({meshes::sphere(260, 260)});
    const CollapseSequence sequence = sequenceOf(submesh);
    const double cosine = std::cos(glm::radians(CollapseOptions{}.flip_angle_deg));
    const auto whole = static_cast<double>(sequence.facesAt(0));
    for (std::uint32_t step = 1; sequence.facesAt(step) > 60'000; step += 1709) {
        ASSERT_EQ(turnedFaces(sequence, submesh, step, cosine), 0u) << "step " << step;
        const std::vector<GeometryPtr> level = readAt(sequence, submesh, step);
        double up = 0.0;
        double down = 0.0;
        for (std::size_t i = 0; i < level[0]->indices.size(); i += 3)
            (level[0]->positions[level[0]->indices[i]].z > 0.0f ? up : down) += 1.0;
        ASSERT_NEAR(up / whole, down / whole, 0.02) << "step " << step;
        if (step % 10 != 5)
            continue;
        const Shape shape = meshes::shapeOf(level);
        ASSERT_EQ(shape.border_edges, 0u) << "step " << step;
        ASSERT_EQ(shape.non_manifold_edges, 0u) << "step " << step;
        ASSERT_EQ(shape.degenerate_faces, 0u) << "step " << step;
    }
}

TEST(Collapse, AFlatSheetKeepsItsOutlineToTheLastFewTriangles) {
    const Submesh submesh = submeshOf({meshes::grid(10)});
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step) {
        const Shape shape = meshes::shapeOf(readAt(sequence, submesh, step));
        ASSERT_NEAR(shape.area, 1.0, 1e-3) << shape.faces << " faces";
        ASSERT_NEAR(glm::length(shape.bounds.min), 0.0, 2e-3) << shape.faces << " faces";
        ASSERT_NEAR(glm::length(shape.bounds.max - glm::dvec3(1, 1, 0)), 0.0, 2e-3);
    }
    EXPECT_LE(sequence.facesAt(sequence.step_count), 4u);
}

TEST(Collapse, TwoSidedCardsKeepBothSides) {
    const Submesh submesh = submeshOf({meshes::card(6)});
    const CollapseSequence sequence = sequenceOf(submesh);
    EXPECT_LE(sequence.facesAt(sequence.step_count), 4u);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step) {
        const GeometryPtr geometry = readAt(sequence, submesh, step)[0];
        double up = 0.0;
        double down = 0.0;
        for (std::size_t t = 0; t < geometry->triangleCount(); ++t) {
            const auto at = [&](std::size_t k) {
                return glm::dvec3(geometry->positions[geometry->indices[3 * t + k]]);
            };
            const double twice = glm::cross(at(1) - at(0), at(2) - at(0)).z;
            (twice > 0.0 ? up : down) += 0.5 * twice;
        }
        ASSERT_NEAR(up, 1.0, 0.02) << geometry->triangleCount() << " faces";
        ASSERT_NEAR(down, -1.0, 0.02) << geometry->triangleCount() << " faces";
    }
}

TEST(Collapse, NoFaceTurnsFurtherThanTheFlipAngle) {
    for (const double angle_deg : {20.0, 80.0, 120.0}) {
        CollapseOptions options;
        options.flip_angle_deg = angle_deg;
        for (const GeometryPtr& geometry : {meshes::sphere(12, 16, 0.3), hills(12)}) {
            const Submesh submesh = submeshOf({geometry});
            const CollapseSequence sequence = sequenceOf(submesh, options);
            std::uint32_t step = 1; // below, the last resort takes any edge
            for (; sequence.facesAt(step) > 150; ++step)
                ASSERT_EQ(turnedFaces(sequence, submesh, step, std::cos(glm::radians(angle_deg))),
                          0u)
                    << "step " << step << ", " << angle_deg << " degrees";
            EXPECT_GT(step, 20u);
        }
    }
}

TEST(Collapse, CostsOfOneComponentRiseButForRejectedEdges) {
    const Submesh submesh = submeshOf({hills(20)});
    const CollapseSequence sequence = sequenceOf(submesh);
    std::uint32_t falls = 0;
    for (std::size_t s = 1; s < sequence.step_count; ++s)
        falls += sequence.cost[s] < 0.5 * sequence.cost[s - 1] ? 1 : 0;
    EXPECT_LT(falls, sequence.step_count / 10);
    EXPECT_GT(sequence.cost[sequence.step_count - 1], sequence.cost[0]);
}

TEST(Collapse, MovingAMeshChangesNeitherOrderNorCost) {
    auto fine = std::make_shared<Geometry>(*meshes::sphere(12, 16));
    for (glm::vec3& p : fine->positions) // exact after a shift by thousands, too
        p = glm::round(p * 1024.0f) / 1024.0f;
    const Submesh here = submeshOf({fine});
    const Submesh there = submeshOf({meshes::moved(fine, {4096.0, -2048.0, 1024.0})});
    const CollapseSequence a = sequenceOf(here);
    const CollapseSequence b = sequenceOf(there);
    EXPECT_EQ(a.cost, b.cost);
    EXPECT_EQ(a.face_death, b.face_death);
    EXPECT_EQ(a.wedge_death, b.wedge_death);
}

TEST(Collapse, ScalingAMeshScalesCostsByTheFourthPowerAndNothingElse) {
    auto large = std::make_shared<Geometry>(*meshes::sphere(12, 16));
    for (glm::vec3& p : large->positions)
        p *= 256.0f;
    const CollapseSequence a = sequenceOf(submeshOf({meshes::sphere(12, 16)}));
    const CollapseSequence b = sequenceOf(submeshOf({large}));
    EXPECT_EQ(a.face_death, b.face_death);
    for (std::size_t s = 0; s < a.cost.size(); ++s)
        EXPECT_NEAR(b.cost[s], a.cost[s] * std::pow(256.0, 4.0), 1e-9 * b.cost[s]);
}

// --- asset classes

struct AssetClass {
    std::string name;
    GeometryPtr geometry;
};

std::ostream& operator<<(std::ostream& out, const AssetClass& asset) {
    return out << asset.name;
}

class CollapseOfAnyMesh : public ::testing::TestWithParam<AssetClass> {};

TEST_P(CollapseOfAnyMesh, ReachesTheFloorWithFiniteVerticesAtEveryStep) {
    const Submesh submesh = submeshOf({GetParam().geometry});
    const CollapseSequence sequence = sequenceOf(submesh);
    const auto clean = static_cast<std::uint32_t>(sequence.complex.faces.size());
    EXPECT_LE(sequence.facesAt(sequence.step_count), 6u); // the next step takes several at once
    EXPECT_GE(sequence.facesAt(sequence.step_count), std::min(4u, clean));
    std::uint32_t last = ~0u;
    const std::uint32_t stride = std::max(1u, sequence.step_count / 60);
    for (std::uint32_t step = 0; step <= sequence.step_count; step += stride) {
        const std::vector<GeometryPtr> primitives = readAt(sequence, submesh, step);
        const Shape shape = meshes::shapeOf(primitives);
        EXPECT_TRUE(shape.finite) << "step " << step;
        EXPECT_LE(shape.faces, last);
        last = shape.faces;
        for (const std::uint32_t index : primitives[0]->indices)
            ASSERT_LT(index, primitives[0]->positions.size());
    }
}

TEST_P(CollapseOfAnyMesh, WithoutFloorsNothingIsLeft) {
    const Submesh submesh = submeshOf({GetParam().geometry});
    const CollapseSequence sequence = sequenceOf(submesh, {}, kNoFloors);
    EXPECT_EQ(sequence.facesAt(sequence.step_count), 0u);
}

std::vector<AssetClass> assetClasses() {
    const auto cube = meshes::sphere(4, 4, 0.0);
    std::vector<glm::vec3> fan{{0, 0, 0}, {0, 0, 1}}; // twenty pages on one spine
    std::vector<std::uint32_t> pages;
    for (std::uint32_t i = 0; i < 20; ++i) {
        fan.emplace_back(std::cos(0.3f * float(i)), std::sin(0.3f * float(i)), 0.5f);
        pages.insert(pages.end(), {0u, 1u, i + 2});
    }
    auto doubled = std::make_shared<Geometry>(*meshes::grid(5));
    const std::vector<std::uint32_t> again = doubled->indices;
    doubled->indices.insert(doubled->indices.end(), again.begin(), again.end());
    auto slivers = std::make_shared<Geometry>(*meshes::grid(8));
    for (glm::vec3& p : slivers->positions)
        p.y = 0.0f;                                                       // all faces collinear
    auto touching = joined(*cube, *meshes::moved(cube, {0.0, 0.0, 2.0})); // share a pole
    auto flipped = std::make_shared<Geometry>(*meshes::grid(8));
    for (std::size_t t = 0; t < flipped->indices.size(); t += 6)
        std::swap(flipped->indices[t], flipped->indices[t + 1]);
    auto tiny = std::make_shared<Geometry>(*meshes::sphere(6, 8));
    for (glm::vec3& p : tiny->positions)
        p *= 1e-20f;
    auto huge = std::make_shared<Geometry>(*meshes::sphere(6, 8));
    for (glm::vec3& p : huge->positions)
        p *= 1e30f;
    return {{"Closed", meshes::sphere(10, 12)},
            {"GenusOne", meshes::torus(10, 6)},
            {"Open", meshes::grid(8)},
            {"Hills", hills(8)},
            {"TwoSided", meshes::card(5)},
            {"Soup", meshes::soup(60)},
            {"FanOnOneEdge", made(fan, pages)},
            {"TouchingAtAVertex", touching},
            {"DuplicateFaces", doubled},
            {"Collinear", slivers},
            {"MixedOrientation", flipped},
            {"Tiny", tiny},
            {"Huge", huge},
            {"Bowtie",
             made({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {0, 1, 2, 0, 3, 4})},
            {"SingleTriangle", made({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2})},
            {"DegenerateOnly", made({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}}, {0, 1, 2, 0, 0, 0})},
            {"BackToBack", made({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 1})},
            {"OnePlace", made({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {0, 1, 2})},
            {"UnusedVertices", made({{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 2, 3})},
            {"Empty", made({}, {})}};
}

INSTANTIATE_TEST_SUITE_P(Classes,
                         CollapseOfAnyMesh,
                         ::testing::ValuesIn(assetClasses()),
                         [](const auto& tested) { return tested.param.name; });

TEST(Collapse, PointsAndLinesStayAsTheyAre) {
    Submesh submesh = submeshOf({meshes::grid(3), meshes::grid(8), meshes::grid(3)});
    submesh.primitives[0].mode = PrimitiveMode::Points;
    submesh.primitives[2].mode = PrimitiveMode::LineStrip;
    const CollapseSequence sequence = sequenceOf(submesh);
    const std::vector<GeometryPtr> last = readAt(sequence, submesh, sequence.step_count);
    EXPECT_EQ(last[0], submesh.primitives[0].geometry);
    EXPECT_EQ(last[2], submesh.primitives[2].geometry);
    EXPECT_EQ(last[1]->triangleCount(), 4u);
}

// --- vertices absurdly far out

TEST(Collapse, AFarVertexDoesNotDefeatTheRest) {
    for (const float far : {1e6f, 1e15f, 1e30f}) {
        auto spiked = std::make_shared<Geometry>(*meshes::sphere(12, 16));
        spiked->positions[100] = {far, -far, 0.5f * far};
        const Submesh submesh = submeshOf({spiked});
        const CollapseSequence sequence = sequenceOf(submesh, {}, {}, 3);
        EXPECT_LE(sequence.facesAt(sequence.step_count), 40u) << far;
        const GeometryPtr half = readAt(sequence, submesh, sequence.step_count / 2)[0];
        for (const glm::vec3& p : half->positions) // on the surface, or the vertex itself
            EXPECT_TRUE(p == spiked->positions[100] || std::abs(glm::length(p) - 1.0f) < 0.2f)
                << far << ": " << p.x << " " << p.y << " " << p.z;
    }
}

TEST(Collapse, AFarComponentDoesNotSetTheOrderOfTheRest) {
    const GeometryPtr near = joined(*meshes::sphere(12, 16, 0.0), *hills(12));
    const GeometryPtr far = made({{1e30f, 0, 0}, {2e30f, 0, 0}, {0, 1e30f, 0}}, {0, 1, 2});
    const Submesh alone = submeshOf({near});
    const Submesh both = submeshOf({joined(*near, *far)});
    const CollapseSequence a = sequenceOf(alone);
    const CollapseSequence b = sequenceOf(both);
    std::uint32_t differing = 0;
    for (std::size_t f = 0; f < a.face_death.size(); ++f)
        differing += a.face_death[f] != b.face_death[f] ? 1 : 0;
    EXPECT_LT(differing, a.face_death.size() / 50);
}

TEST(Collapse, FewInstancesAreCollapsedOn) {
    const Submesh submesh = submeshOf({meshes::sphere(12, 16)});
    const CollapseSequence sequence = sequenceOf(submesh, {}, {}, 15);
    EXPECT_EQ(sequence.facesAt(sequence.step_count), 4u);
}

TEST(Collapse, ManyInstancesKeepTheShareOfTheirShapeThatTheFloorSays) {
    const Submesh submesh = submeshOf({meshes::sphere(12, 16)});
    const Shape whole = meshes::shapeOf(std::array{submesh.primitives[0].geometry});
    std::size_t faces = 0;
    for (const double floor : {FloorOptions{}.min_shape, 0.8, 0.95}) {
        FloorOptions floors;
        floors.min_shape = floor;
        const CollapseSequence sequence = sequenceOf(submesh, {}, floors, 16);
        const Shape least = meshes::shapeOf(readAt(sequence, submesh, sequence.step_count));
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_GE(least.bounds.size()[axis], 0.999 * floor * whole.bounds.size()[axis]);
        EXPECT_GE(least.area, 0.999 * 0.625 * floor * whole.area);
        EXPECT_GT(least.faces, faces) << "the floor " << floor << " holds no more than a lower one";
        faces = least.faces;
    }
    EXPECT_LT(faces, whole.faces);
}

// Its sag is a hundredth of its size: the floor on extents must not hold on to it.
TEST(Collapse, ASaggingLeafOfManyInstancesMayBecomeFlat) {
    auto leaf = std::make_shared<Geometry>(*meshes::grid(8));
    for (glm::vec3& p : leaf->positions)
        p.z = 0.02f * (p.x * (1.0f - p.x) + p.y * (1.0f - p.y));
    const Submesh submesh = submeshOf({leaf});
    FloorOptions floors;
    floors.min_shape = 0.8;
    const CollapseSequence sequence = sequenceOf(submesh, {}, floors, 16);
    const Shape least = meshes::shapeOf(readAt(sequence, submesh, sequence.step_count));
    EXPECT_EQ(least.faces, 4u);
    EXPECT_GE(least.bounds.size().x, 0.799);
    EXPECT_GE(least.bounds.size().y, 0.799);
}

} // namespace lodestone
