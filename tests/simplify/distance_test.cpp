#include "simplify/measure/closest_surface.h"
#include "simplify/measure/distance.h"
#include "simplify/measure/surface_samples.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>
#include <tbb/global_control.h>

namespace lodestone {

namespace {

// A bumpy sphere of 2 * rings * segments triangles around `center`.
GeometryPtr makeBlob(int rings, int segments, const glm::dvec3& center = glm::dvec3(0.0)) {
    auto geometry = std::make_shared<Geometry>();
    for (int r = 0; r <= rings; ++r)
        for (int s = 0; s < segments; ++s) {
            const double polar = 3.14159265358979 * r / rings;
            const double around = 6.28318530717959 * s / segments;
            const double radius = 1.0 + 0.1 * std::sin(5.0 * polar) * std::cos(3.0 * around);
            geometry->positions.emplace_back(center +
                                             radius * glm::dvec3(std::sin(polar) * std::cos(around),
                                                                 std::sin(polar) * std::sin(around),
                                                                 std::cos(polar)));
        }
    const auto at = [&](int r, int s) {
        return static_cast<std::uint32_t>(r * segments + s % segments);
    };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s)
            for (const std::uint32_t index : {at(r, s),
                                              at(r + 1, s),
                                              at(r + 1, s + 1),
                                              at(r, s),
                                              at(r + 1, s + 1),
                                              at(r, s + 1)})
                geometry->indices.push_back(index);
    return geometry;
}

// Two triangles spanning [0,1]^2 at height z.
GeometryPtr makeSquare(float z) {
    auto geometry = std::make_shared<Geometry>();
    geometry->positions = {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}};
    geometry->indices = {0, 1, 2, 0, 2, 3};
    return geometry;
}

Scene makeScene(const std::vector<GeometryPtr>& geometries,
                const std::vector<std::vector<glm::dmat4>>& transforms) {
    Scene scene;
    scene.name = "made.glb";
    for (std::size_t s = 0; s < geometries.size(); ++s) {
        Primitive primitive;
        primitive.geometry = geometries[s];
        scene.submeshes.push_back({"submesh", {primitive}});
        for (const glm::dmat4& transform : transforms[s])
            scene.instances.push_back({transform, static_cast<std::uint32_t>(s), kNone, kNone});
    }
    return scene;
}

Scene makeScene(const GeometryPtr& geometry, const std::vector<glm::dmat4>& transforms) {
    return makeScene(std::vector<GeometryPtr>{geometry}, {transforms});
}

Result<Distance> measure(const Scene& a, const Scene& b, std::uint64_t samples = 20'000) {
    const Lod lod_a = fullLod(a);
    const Lod lod_b = fullLod(b);
    return measureDistance({&a, &lod_a}, {&b, &lod_b}, {samples, 1}, {});
}

glm::dmat4 shear(double xy, double yz) {
    glm::dmat4 matrix(1.0);
    matrix[1][0] = xy;
    matrix[2][1] = yz;
    return matrix;
}

// Sheared, mirrored, stretched, far from each other, one flat.
std::vector<glm::dmat4> difficultTransforms() {
    const auto moved = [](double x, double y, double z, const glm::dmat4& linear) {
        return glm::translate(glm::dmat4(1.0), {x, y, z}) * linear;
    };
    const glm::dmat4 one(1.0);
    return {moved(0, 0, 0, shear(0.8, -0.4)),
            moved(3, 0, 0, glm::scale(one, {-1, 1, 1})),
            moved(0, 3, 0, glm::scale(one, {0.02, 1, 3}) * shear(2.0, 0.1)),
            moved(3, 3, 0, glm::rotate(one, 0.7, {1, 2, 3}) * glm::scale(one, {2, -0.3, 0.5})),
            moved(0, 0, 4, glm::rotate(one, 1.9, {3, 1, 0}) * glm::scale(one, glm::dvec3(0.4))),
            moved(6, 1, 1, glm::scale(one, {1, 1, 0}))};
}

double bruteForce(std::span<const SurfacePiece> pieces, const glm::dvec3& point) {
    double best = std::numeric_limits<double>::infinity();
    for (const SurfacePiece& piece : pieces)
        for (std::size_t t = 0; t < piece.geometry->triangleCount(); ++t)
            best = std::min(best, squaredDistance(point, piece.triangle(t)));
    return std::sqrt(best);
}

void expectBruteForceDistances(const Scene& scene, double tolerance) {
    const Lod lod = fullLod(scene);
    const Result<SurfaceFrame> frame = frameOf(scene);
    ASSERT_TRUE(frame);
    const std::vector<SurfacePiece> pieces = surfacePieces({&scene, &lod}, *frame);
    const Result<ClosestSurface> surface = ClosestSurface::build(pieces, {});
    ASSERT_TRUE(surface) << surface.error().message;
    ClosestSurface::Cursor cursor(*surface);
    std::mt19937 random(7);
    std::uniform_real_distribution<double> inside(-0.6, 0.6);
    for (int i = 0; i < 400; ++i) {
        const double spread = i % 10 == 0 ? 50.0 : 1.0; // some from far away
        const glm::dvec3 point =
            spread * glm::dvec3(inside(random), inside(random), inside(random));
        EXPECT_NEAR(cursor.closest(point).distance, bruteForce(pieces, point), tolerance)
            << "point " << i;
    }
}

} // namespace

TEST(Distance, WhatIsNearEnoughIsFoundWhereThereIsSuch) {
    const Scene scene = makeScene(makeBlob(24, 32), difficultTransforms());
    const Lod lod = fullLod(scene);
    const Result<SurfaceFrame> frame = frameOf(scene);
    ASSERT_TRUE(frame);
    const std::vector<SurfacePiece> pieces = surfacePieces({&scene, &lod}, *frame);
    const Result<ClosestSurface> surface = ClosestSurface::build(pieces, {});
    ASSERT_TRUE(surface);
    ClosestSurface::Cursor exact(*surface);
    ClosestSurface::Cursor hasty(*surface);
    constexpr double kEnough = 0.05;
    std::mt19937 random(8);
    std::uniform_real_distribution<double> inside(-0.6, 0.6);
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 point(inside(random), inside(random), inside(random));
        const double closest = exact.closest(point).distance;
        const ClosestSurface::Hit hit = hasty.closest(point, kEnough);
        if (closest > kEnough)
            EXPECT_NEAR(hit.distance, closest, 1e-6) << "point " << i;
        else
            EXPECT_LE(hit.distance, kEnough) << "point " << i;
        EXPECT_NEAR(hit.distance, std::sqrt(squaredDistance(point, surface->triangle(hit))), 1e-6);
    }
}

TEST(Distance, OfASceneToItselfIsZero) {
    const Scene scene = makeScene(makeBlob(24, 32), difficultTransforms());
    const Result<Distance> distance = measure(scene, scene);
    ASSERT_TRUE(distance) << distance.error().message;
    EXPECT_LT(distance->hausdorff, 1e-4);
    EXPECT_LT(distance->mean, 1e-5);
    EXPECT_EQ(distance->samples, 40'000u);
}

TEST(Distance, OfParallelSquaresIsTheirGapInPercentOfTheDiagonal) {
    const Scene a = makeScene(makeSquare(0.0f), {glm::dmat4(1.0)});
    const Scene b = makeScene(makeSquare(0.25f), {glm::dmat4(1.0)});
    const Result<Distance> distance = measure(a, b);
    ASSERT_TRUE(distance);
    const double expected = 100.0 * 0.25 / std::sqrt(2.0);
    EXPECT_NEAR(distance->hausdorff, expected, 1e-4);
    EXPECT_NEAR(distance->mean, expected, 1e-4);
    EXPECT_NEAR(distance->rms, expected, 1e-4);
}

TEST(Distance, MaximumComesFromTheSideThatHasMore) {
    const Scene one = makeScene(makeSquare(0.0f), {glm::dmat4(1.0)});
    const Scene two =
        makeScene(makeSquare(0.0f),
                  {glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), glm::dvec3(4.0, 0.0, 0.0))});
    const Result<Distance> distance = measure(one, two);
    ASSERT_TRUE(distance);
    EXPECT_NEAR(distance->a_to_b_max, 0.0, 1e-4);
    // The far edge of the second square, found through its vertices.
    EXPECT_NEAR(distance->b_to_a_max, 100.0 * 4.0 / std::sqrt(2.0), 1e-3);
    // Half of b lies on a, the other half 3..4 away from it.
    EXPECT_NEAR(distance->b_to_a_mean, 100.0 * 0.5 * 3.5 / std::sqrt(2.0), 0.5);
    EXPECT_EQ(distance->hausdorff, distance->b_to_a_max);
}

TEST(Distance, MaximumIsFoundInsideATriangleThatSamplesMiss) {
    // A square over the same square with a hole, 0.01 wide, at none of the two large triangles'
    // corners or middles.
    constexpr int kCells = 100;
    const auto holed = std::make_shared<Geometry>();
    for (int y = 0; y <= kCells; ++y)
        for (int x = 0; x <= kCells; ++x)
            holed->positions.emplace_back(
                static_cast<float>(x) / kCells, static_cast<float>(y) / kCells, 0.0f);
    const auto center = static_cast<std::uint32_t>(37 * (kCells + 1) + 71);
    for (std::uint32_t y = 0; y < kCells; ++y)
        for (std::uint32_t x = 0; x < kCells; ++x) {
            const std::uint32_t at = y * (kCells + 1) + x;
            const std::uint32_t above = at + kCells + 1;
            for (const std::uint32_t index : {at, at + 1, above + 1, at, above + 1, above})
                holed->indices.push_back(index);
        }
    std::vector<std::uint32_t> kept;
    for (std::size_t t = 0; t < holed->triangleCount(); ++t) {
        const auto corners = std::span(holed->indices).subspan(3 * t, 3);
        if (std::ranges::find(corners, center) == corners.end())
            kept.insert(kept.end(), corners.begin(), corners.end());
    }
    holed->indices = kept;
    const Scene a = makeScene(makeSquare(0.0f), {glm::dmat4(1.0)});
    const Scene b = makeScene(holed, {glm::dmat4(1.0)});
    const Result<Distance> distance = measure(a, b, 100);
    ASSERT_TRUE(distance);
    // The hole's middle is farthest from its rim, a hexagon: its nearest side is 0.01 / sqrt(2)
    // away.
    const double expected = 100.0 * (0.01 / std::sqrt(2.0)) / std::sqrt(2.0);
    EXPECT_NEAR(distance->a_to_b_max, expected, 0.01 * expected);
    EXPECT_LE(distance->a_to_b_max, expected * (1.0 + 1e-4));
}

TEST(Distance, OnlyKeptInstancesCount) {
    const Scene scene =
        makeScene(makeSquare(0.0f),
                  {glm::dmat4(1.0), glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 1.0))});
    const Lod full = fullLod(scene);
    Lod fewer = full;
    fewer.submeshes[0].instance_order =
        std::make_shared<const std::vector<std::uint32_t>>(std::vector<std::uint32_t>{1, 0});
    fewer.submeshes[0].kept_instances = 1;
    const Result<Distance> distance =
        measureDistance({&scene, &full}, {&scene, &fewer}, {1000, 1}, {});
    ASSERT_TRUE(distance);
    EXPECT_NEAR(distance->a_to_b_max, 100.0 / std::sqrt(3.0), 1e-3);
    EXPECT_NEAR(distance->a_to_b_mean, 50.0 / std::sqrt(3.0), 1e-3);
    EXPECT_NEAR(distance->b_to_a_max, 0.0, 1e-4);
}

TEST(Distance, EqualsBruteForceForShearedMirroredAndFlatInstances) {
    expectBruteForceDistances(makeScene(makeBlob(12, 16), difficultTransforms()), 1e-6);
}

TEST(Distance, EqualsBruteForceWhereVerticesLieFarFromTheirOrigin) {
    const glm::dvec3 center(40'000.0, -70'000.0, 20'000.0);
    std::vector<glm::dmat4> transforms = difficultTransforms();
    for (glm::dmat4& transform : transforms)
        transform = transform * glm::translate(glm::dmat4(1.0), -center);
    expectBruteForceDistances(makeScene(makeBlob(12, 16, center), transforms), 1e-6);
}

TEST(Distance, EqualsBruteForceForManySmallOverlappingInstances) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    std::vector<glm::dmat4> transforms;
    for (int i = 0; i < 300; ++i) {
        glm::dmat4 transform = glm::translate(
            glm::dmat4(1.0), 10.0 * glm::dvec3(unit(random), unit(random), unit(random)));
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                transform[column][row] = 0.5 * unit(random);
        transforms.push_back(transform);
    }
    expectBruteForceDistances(makeScene(makeBlob(3, 5), transforms), 1e-6);
}

TEST(Distance, IsBitEqualForAnyNumberOfThreads) {
    const Scene a = makeScene(makeBlob(24, 32), difficultTransforms());
    const Scene b = makeScene(makeBlob(9, 12), difficultTransforms());
    const auto measure_with = [&](std::size_t thread_count) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, thread_count);
        return measure(a, b).value();
    };
    const Distance one = measure_with(1);
    const Distance four = measure_with(4);
    EXPECT_EQ(one.hausdorff, four.hausdorff);
    EXPECT_EQ(one.mean, four.mean);
    EXPECT_EQ(one.rms, four.rms);
    EXPECT_GT(one.mean, 0.0);
}

TEST(Distance, FarOutlierDoesNotDefeatTheRest) {
    const auto with_outlier = std::make_shared<Geometry>(*makeBlob(24, 32));
    with_outlier->positions.emplace_back(1e30f, 0.0f, 0.0f);
    const auto outlier = static_cast<std::uint32_t>(with_outlier->positions.size() - 1);
    with_outlier->indices.insert(with_outlier->indices.end(), {0u, 1u, outlier});
    const Scene a = makeScene(with_outlier, {glm::dmat4(1.0)});
    const Scene b = makeScene(makeBlob(12, 16), {glm::dmat4(1.0)});
    const Scene plain = makeScene(makeBlob(24, 32), {glm::dmat4(1.0)});
    const Result<Distance> distance = measure(a, b);
    const Result<Distance> expected = measure(plain, b);
    ASSERT_TRUE(distance) << distance.error().message;
    ASSERT_TRUE(expected);
    EXPECT_NEAR(distance->mean, expected->mean, 0.02 * expected->mean);
    EXPECT_NEAR(distance->hausdorff, expected->hausdorff, 0.02 * expected->hausdorff);
}

TEST(Distance, NothingToMeasureIsBadInput) {
    const auto points = std::make_shared<Geometry>();
    points->positions = {{0, 0, 0}, {1, 1, 1}};
    Scene empty = makeScene(GeometryPtr(points), {glm::dmat4(1.0)});
    empty.submeshes[0].primitives[0].mode = PrimitiveMode::Points;
    const Scene full = makeScene(makeSquare(0.0f), {glm::dmat4(1.0)});
    const auto flat = std::make_shared<Geometry>(*points);
    flat->indices = {0, 1, 1};
    for (const Scene& other : {empty, makeScene(GeometryPtr(flat), {glm::dmat4(1.0)})}) {
        const Result<Distance> distance = measure(full, other);
        ASSERT_FALSE(distance);
        EXPECT_EQ(distance.error().kind, ErrorKind::BadInput);
    }
}

TEST(Distance, StopRequestCancels) {
    const Scene scene = makeScene(makeBlob(24, 32), difficultTransforms());
    const Lod lod = fullLod(scene);
    std::stop_source source;
    JobContext job;
    job.stop = source.get_token();
    job.progress = [&](double fraction) {
        if (fraction > 0.2)
            source.request_stop();
    };
    const Result<Distance> distance =
        measureDistance({&scene, &lod}, {&scene, &lod}, {20'000'000, 1}, job);
    ASSERT_FALSE(distance);
    EXPECT_EQ(distance.error().kind, ErrorKind::Cancelled);
}

TEST(SurfaceSampler, SpreadsSamplesByWorldAreaOfInstances) {
    const Scene scene = makeScene(makeSquare(0.0f),
                                  {glm::dmat4(1.0),
                                   glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, 0.0, 1.0)) *
                                       glm::scale(glm::dmat4(1.0), glm::dvec3(3.0, 1.0, 1.0))});
    const Lod lod = fullLod(scene);
    const std::vector<SurfacePiece> pieces = surfacePieces({&scene, &lod}, SurfaceFrame{});
    const Result<SurfaceSampler> sampler = SurfaceSampler::build(pieces, {});
    ASSERT_TRUE(sampler);
    EXPECT_DOUBLE_EQ(sampler->area(), 4.0);
    int large_count = 0;
    int count = 0;
    double x_sum = 0.0;
    sampler->visit({0, 4000, 4000, 1}, [&](const SurfaceSample& sample) {
        ++count;
        if (sample.point.z > 0.5) {
            ++large_count;
            x_sum += sample.point.x;
        }
    });
    EXPECT_EQ(count, 4000);
    EXPECT_NEAR(large_count, 3000, 1); // stratified
    EXPECT_NEAR(x_sum / large_count, 1.5, 0.05);
}

TEST(SurfaceSampler, BlocksGiveTheSamePointsAsOneRun) {
    const Scene scene = makeScene(makeBlob(40, 60), difficultTransforms());
    const Lod lod = fullLod(scene);
    const std::vector<SurfacePiece> pieces = surfacePieces({&scene, &lod}, SurfaceFrame{});
    const Result<SurfaceSampler> sampler = SurfaceSampler::build(pieces, {});
    ASSERT_TRUE(sampler);
    std::vector<glm::dvec3> whole;
    std::vector<glm::dvec3> blocks;
    sampler->visit({0, 5000, 5000, 9}, [&](const SurfaceSample& s) { whole.push_back(s.point); });
    for (std::uint64_t begin = 0; begin < 5000; begin += 100)
        sampler->visit({begin, begin + 100, 5000, 9},
                       [&](const SurfaceSample& s) { blocks.push_back(s.point); });
    EXPECT_EQ(whole, blocks);
}

} // namespace lodestone
