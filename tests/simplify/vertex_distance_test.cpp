#include "simplify/measure/vertex_distance.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

// Two triangles spanning [0,1]^2 at z = 0, with a vertex that no triangle uses.
GeometryPtr square() {
    auto geometry = std::make_shared<Geometry>();
    geometry->positions = {{0, 0, 0}, {1, 0, 0}, {9, 9, 9}, {1, 1, 0}, {0, 1, 0}};
    geometry->indices = {0, 1, 3, 0, 3, 4};
    return geometry;
}

Scene squareAt(const std::vector<glm::dvec3>& places) {
    Scene scene;
    scene.name = "square.glb";
    Primitive primitive;
    primitive.geometry = square();
    scene.submeshes.push_back({"square", {primitive}});
    for (const glm::dvec3& place : places)
        scene.instances.push_back({glm::translate(glm::dmat4(1.0), place), 0, kNone, kNone});
    return scene;
}

VertexDistanceField measure(const Scene& view, const Scene& reference, std::uint64_t points) {
    const Lod lod = fullLod(view);
    const Lod reference_lod = fullLod(reference);
    const auto field = measureVertexDistances(
        {&view, &lod}, {&reference, &reference_lod}, VertexDistanceOptions{points}, {});
    EXPECT_TRUE(field);
    return field.value_or(VertexDistanceField{});
}

} // namespace

TEST(VertexDistances, MaxAndMeanAreOverTheInstancesInPercentOfTheDiagonal) {
    const Scene reference = squareAt({{0, 0, 0}});
    const Scene view = squareAt({{0, 0, 0.1}, {0, 0, 0.3}});
    const VertexDistanceField field = measure(view, reference, 1000);
    ASSERT_EQ(field.size(), 1u);
    const VertexDistances& distances = field[0].at(0);
    ASSERT_EQ(distances.max.size(), 5u);
    // The unused vertex counts for the diagonal of the reference's bounds or not; ask its frame.
    const double diagonal = robustWorldBounds(reference).diagonal();
    for (const std::size_t v : {0u, 1u, 3u, 4u}) {
        EXPECT_NEAR(distances.max[v], 100.0 * 0.3 / diagonal, 1e-4);
        EXPECT_NEAR(distances.mean[v], 100.0 * 0.2 / diagonal, 1e-4);
    }
}

TEST(VertexDistances, UnusedVerticesAreZero) {
    const VertexDistanceField field = measure(squareAt({{0, 0, 1}}), squareAt({{0, 0, 0}}), 1000);
    EXPECT_EQ(field.at(0).at(0).max.at(2), 0.0f);
    EXPECT_EQ(field.at(0).at(0).mean.at(2), 0.0f);
}

TEST(VertexDistances, EachVertexHasItsOwn) {
    // Shifted along x by half: two corners lie on the reference, two are half a unit off.
    const Scene reference = squareAt({{0, 0, 0}});
    const VertexDistanceField field = measure(squareAt({{0.5, 0, 0}}), reference, 1000);
    const VertexDistances& distances = field.at(0).at(0);
    const double half = 100.0 * 0.5 / robustWorldBounds(reference).diagonal();
    EXPECT_NEAR(distances.max[0], 0.0, 1e-4);
    EXPECT_NEAR(distances.max[1], half, 1e-4);
    EXPECT_NEAR(distances.max[3], half, 1e-4);
    EXPECT_NEAR(distances.max[4], 0.0, 1e-4);
}

TEST(VertexDistances, FewPointsStillMeasureAnInstanceOfEverySubmesh) {
    const Scene reference = squareAt({{0, 0, 0}});
    const Scene view = squareAt({{0, 0, 0.1}, {0, 0, 0.3}, {0, 0, 0.5}});
    const VertexDistanceField field = measure(view, reference, 1);
    const double tenth = 100.0 * 0.1 / robustWorldBounds(reference).diagonal();
    EXPECT_NEAR(field.at(0).at(0).max[0], tenth, 1e-4);
    EXPECT_NEAR(field.at(0).at(0).mean[0], tenth, 1e-4);
}

TEST(VertexDistances, PrimitivesWithoutTrianglesAreEmpty) {
    Scene view = squareAt({{0, 0, 0}});
    Primitive points = view.submeshes[0].primitives[0];
    points.mode = PrimitiveMode::Points;
    view.submeshes[0].primitives.push_back(points);
    const VertexDistanceField field = measure(view, squareAt({{0, 0, 0}}), 1000);
    ASSERT_EQ(field.at(0).size(), 2u);
    EXPECT_EQ(field[0][0].max.size(), 5u);
    EXPECT_TRUE(field[0][1].max.empty());
}

} // namespace lodestone
