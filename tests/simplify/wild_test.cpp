#include "scene/expand.h"
#include "simplify/algorithm.h"
#include "simplify/wild/triangle_distance.h"
#include "simplify/wild/virtual_edges.h"
#include "simplify/wild/wild.h"
#include "tests/simplify/damaged_meshes.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <random>

using namespace lodestone;
using namespace lodestone::meshes;

namespace {

ScenePtr sceneWith(std::vector<GeometryPtr> primitives) {
    return sceneOf({submeshOf(std::move(primitives))}, {{glm::dmat4(1.0)}});
}

// Several geometries without attributes as one.
GeometryPtr together(const std::vector<GeometryPtr>& parts) {
    Geometry all;
    for (const GeometryPtr& part : parts) {
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        all.positions.insert(all.positions.end(), part->positions.begin(), part->positions.end());
        for (const std::uint32_t index : part->indices)
            all.indices.push_back(first + index);
    }
    return std::make_shared<const Geometry>(std::move(all));
}

LodSourcePtr wild(const ScenePtr& scene, const ParameterValues& values) {
    Result<LodSourcePtr> source = wildAlgorithm().prepare(scene, values, {}, {});
    EXPECT_TRUE(source) << source.error().message;
    return source ? *source : nullptr;
}

Complex complexOf(const std::vector<GeometryPtr>& primitives, const VirtualEdgeOptions& options) {
    Complex complex = buildComplex(submeshOf(primitives), {});
    addVirtualEdges(complex, options, {});
    return complex;
}

using Edge = std::array<std::uint32_t, 2>; // lower vertex first

std::vector<std::uint32_t> componentOfFaces(const Complex& complex) {
    std::vector<std::uint32_t> of_face(complex.faces.size());
    for (std::uint32_t c = 0; c < complex.componentCount(); ++c)
        for (std::uint32_t i = complex.component_begin[c]; i < complex.component_begin[c + 1]; ++i)
            of_face[complex.component_faces[i]] = c;
    return of_face;
}

// What addVirtualEdges promises, by a loop over all pairs of faces. apart: without such edges.
std::vector<Edge> edgesByBruteForce(const Complex& apart, double reach) {
    const std::vector<std::uint32_t> component = componentOfFaces(apart);
    const auto vertex = [&](std::size_t face, std::size_t corner) {
        return apart.wedge_vertex[apart.faces[face][corner]];
    };
    const auto triangle = [&](std::size_t face) {
        Triangle t;
        for (std::size_t k = 0; k < 3; ++k)
            t[k] = glm::dvec3(apart.positions[vertex(face, k)]);
        return t;
    };
    const auto nearest = [](const Triangle& t, const glm::dvec3& at) {
        std::size_t best = 0;
        for (std::size_t k = 1; k < 3; ++k)
            best = glm::length(t[k] - at) < glm::length(t[best] - at) ? k : best;
        return best;
    };
    // The shortest by vertex and other component.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<double, std::uint32_t>> shortest;
    const auto offer =
        [&](std::uint32_t from, std::uint32_t to, std::uint32_t other, double length) {
            const auto [found, fresh] = shortest.try_emplace({from, other}, length, to);
            if (!fresh)
                found->second = std::min(found->second, {length, to});
        };
    for (std::size_t f = 0; f < apart.faces.size(); ++f)
        for (std::size_t g = f + 1; g < apart.faces.size(); ++g) {
            const Triangle one = triangle(f);
            const Triangle two = triangle(g);
            const auto gap =
                component[f] == component[g] ? std::nullopt : triangleGap(one, two, reach);
            if (!gap)
                continue;
            const std::size_t k = nearest(one, gap->at[0]);
            const std::size_t l = nearest(two, gap->at[1]);
            const double length = glm::length(one[k] - two[l]);
            offer(vertex(f, k), vertex(g, l), component[g], length);
            offer(vertex(g, l), vertex(f, k), component[f], length);
        }
    std::vector<Edge> mutual;
    for (const auto& [at, edge] : shortest)
        for (const auto& [back, other] : shortest)
            if (back.first == edge.second && other.second == at.first && at.first < back.first)
                mutual.push_back({at.first, back.first});
    std::ranges::sort(mutual);
    mutual.erase(std::unique(mutual.begin(), mutual.end()), mutual.end());
    return mutual;
}

// Patches of four triangles, turned and thrown about in a box.
std::vector<GeometryPtr> thrownPatches(int count, double box, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> any(-1.0f, 1.0f);
    std::vector<GeometryPtr> patches;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 at =
            static_cast<float>(box) * glm::vec3(any(random), any(random), any(random));
        Geometry patch;
        for (int corner = 0; corner < 6; ++corner)
            patch.positions.push_back(at + glm::vec3(any(random), any(random), any(random)));
        patch.indices = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 5};
        patches.push_back(std::make_shared<const Geometry>(patch));
    }
    return patches;
}

constexpr double kFar = std::numeric_limits<double>::infinity();

// Distance by brute force over a grid of points on both triangles.
double sampledGap(const Triangle& a, const Triangle& b) {
    constexpr int kSteps = 40;
    double best = 1e9;
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; i + j <= kSteps; ++j) {
            const double u = double(i) / kSteps;
            const double v = double(j) / kSteps;
            const glm::dvec3 on_a = a[0] + (a[1] - a[0]) * u + (a[2] - a[0]) * v;
            const glm::dvec3 on_b = b[0] + (b[1] - b[0]) * u + (b[2] - b[0]) * v;
            best = std::min(best, std::sqrt(squaredDistance(on_a, b)));
            best = std::min(best, std::sqrt(squaredDistance(on_b, a)));
        }
    return best;
}

} // namespace

TEST(TriangleGap, AgreesWithSamplesAndItsOwnPoints) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> at(-1.0, 1.0);
    for (int round = 0; round < 300; ++round) {
        Triangle a;
        Triangle b;
        for (std::size_t k = 0; k < 3; ++k) {
            a[k] = {at(random), at(random), at(random)};
            b[k] = glm::dvec3(at(random), at(random), at(random)) + glm::dvec3(round % 3, 0, 0);
        }
        if (round % 5 == 0)
            b[2] = b[1]; // a segment
        const auto found = triangleGap(a, b, kFar);
        ASSERT_TRUE(found);
        const TriangleGap& gap = *found;
        EXPECT_NEAR(gap.distance, glm::length(gap.at[0] - gap.at[1]), 1e-12);
        EXPECT_LT(std::sqrt(squaredDistance(gap.at[0], a)), 1e-9);
        EXPECT_LT(std::sqrt(squaredDistance(gap.at[1], b)), 1e-9);
        const double sampled = sampledGap(a, b);
        EXPECT_LE(gap.distance, sampled + 1e-9);
        EXPECT_GE(gap.distance, sampled - 0.08); // the samples' spacing
        for (const double below : {0.9 * gap.distance, gap.distance, 1.1 * gap.distance + 1e-9}) {
            const auto nearer = triangleGap(a, b, below);
            ASSERT_EQ(nearer.has_value(), gap.distance < below);
            if (nearer) {
                EXPECT_EQ(nearer->distance, gap.distance);
            }
        }
    }
}

TEST(TriangleGap, IsZeroWhereTrianglesCross) {
    const Triangle flat{glm::dvec3(0, 0, 0), {2, 0, 0}, {0, 2, 0}};
    const Triangle through{glm::dvec3(0.5, 0.5, -1), {0.5, 0.5, 1}, {3, 3, 1}};
    for (const auto& gap : {triangleGap(flat, through, kFar), triangleGap(through, flat, 1e-9)}) {
        ASSERT_TRUE(gap);
        EXPECT_EQ(gap->distance, 0.0);
    }
}

TEST(VirtualEdges, JoinPartsWhoseSurfacesTouchThoughTheirVerticesAreFarApart) {
    // A post stands in the middle of a large floor of two triangles.
    const auto floor = grid(1);
    auto post = moved(grid(1), {0.5, 0.4, 0.0});
    const Complex by_triangle =
        complexOf({floor, moved(post, {0, 0, 1e-3})}, {0.01, VirtualEdgeRule::Triangles});
    EXPECT_FALSE(by_triangle.virtual_edges.empty());
    EXPECT_EQ(by_triangle.componentCount(), 1u);
    const Complex by_vertex =
        complexOf({floor, moved(post, {0, 0, 1e-3})}, {0.01, VirtualEdgeRule::Vertices});
    EXPECT_TRUE(by_vertex.virtual_edges.empty());
    EXPECT_EQ(by_vertex.componentCount(), 2u);
}

TEST(VirtualEdges, EndInDifferentComponentsAndLieInTheirJoinedOne) {
    std::vector<GeometryPtr> parts;
    for (int i = 0; i < 6; ++i)
        parts.push_back(moved(grid(3), {0.0, 0.0, 0.01 * i + (i > 2 ? 5.0 : 0.0)}));
    const Complex apart = complexOf(parts, {});
    const Complex joined = complexOf(parts, {0.01, VirtualEdgeRule::Triangles});
    EXPECT_EQ(apart.componentCount(), 6u);
    ASSERT_EQ(joined.componentCount(), 2u);
    ASSERT_EQ(joined.virtual_begin.size(), 3u);
    EXPECT_EQ(joined.virtual_begin.back(), joined.virtual_edges.size());
    EXPECT_EQ(joined.component_begin.back(), joined.faces.size());
    for (std::size_t c = 0; c < 2; ++c)
        for (std::uint32_t e = joined.virtual_begin[c]; e < joined.virtual_begin[c + 1]; ++e)
            for (const std::uint32_t v : joined.virtual_edges[e])
                EXPECT_EQ(joined.positions[v].z > 2.0f, c == 1);
}

TEST(VirtualEdges, AreThoseOfALoopOverAllPairsOfFaces) {
    constexpr double kEpsilon = 0.05;
    std::size_t found = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const std::vector<GeometryPtr> patches = thrownPatches(24, 4.0, seed);
        const Complex apart = complexOf(patches, {});
        ASSERT_EQ(apart.componentCount(), 24u);
        Bounds bounds;
        for (const glm::vec3& p : apart.positions)
            if (apart.bulk.holds(glm::dvec3(p)))
                bounds.add(glm::dvec3(p));
        const Complex joined = complexOf(patches, {kEpsilon, VirtualEdgeRule::Triangles});
        std::vector<Edge> edges;
        for (const auto& [a, b] : joined.virtual_edges)
            edges.push_back({std::min(a, b), std::max(a, b)});
        std::ranges::sort(edges);
        EXPECT_EQ(edges, edgesByBruteForce(apart, kEpsilon * bounds.diagonal())) << seed;
        found += edges.size();
    }
    EXPECT_GT(found, 100u); // or nothing was compared
}

TEST(VirtualEdges, AreFewAtEveryVertexOfAHeapInWhichAllIsNearAllElse) {
    const Complex joined = complexOf(thrownPatches(300, 0.5, 3), {0.1, VirtualEdgeRule::Triangles});
    std::vector<int> at_vertex(joined.positions.size(), 0);
    for (const auto& [a, b] : joined.virtual_edges) {
        ++at_vertex[a];
        ++at_vertex[b];
    }
    EXPECT_LE(*std::ranges::max_element(at_vertex), 8);
    EXPECT_GT(joined.virtual_edges.size(), joined.positions.size());
}

TEST(VirtualEdges, NoneWithoutADistance) {
    const Complex complex = complexOf({grid(3), moved(grid(3), {0, 0, 1e-4})}, {});
    EXPECT_TRUE(complex.virtual_edges.empty());
    EXPECT_EQ(complex.componentCount(), 2u);
}

TEST(Wild, SheetsThatLieOnEachOtherKeepTheirAreaOrThatOfOne) {
    const GeometryPtr sheets = together({grid(8), moved(grid(8), {0.0, 0.0, 1e-4})});
    const ScenePtr scene = sceneWith({sheets});
    const LodSourcePtr source = wild(scene, {{"epsilon", 1.0}});
    const ByteModel bytes(source->scene(), {});
    const Lod half =
        source->readOut(source->resolve({Target::Kind::Ratio, 0.5}, bytes).position, nullptr);
    const Shape shape = shapeOf(half.submeshes.front().primitives);
    const double sheets_left = shape.area > 1.5 ? 2.0 : 1.0;
    EXPECT_NEAR(shape.area, sheets_left, 0.01 * sheets_left);
    EXPECT_LT(source->errorAt(half.position), 0.1);
    EXPECT_EQ(shape.degenerate_faces, 0u);
}

TEST(Wild, KeepsTheAreaOfCardsThatPlanesAloneEatUp) {
    std::vector<GeometryPtr> cards;
    for (int i = 0; i < 30; ++i)
        cards.push_back(moved(grid(4), {1.5 * (i % 6), 1.5 * (i / 6), 0.0}));
    const ScenePtr scene = sceneWith({together(cards)});
    const auto area_at = [&](double weight) {
        const LodSourcePtr source = wild(scene, {{"area", weight}});
        const ByteModel bytes(source->scene(), {});
        const Lod lod =
            source->readOut(source->resolve({Target::Kind::Ratio, 0.07}, bytes).position, nullptr);
        return shapeOf(lod.submeshes.front().primitives).area;
    };
    EXPECT_NEAR(area_at(1.0), 30.0, 0.3);
    EXPECT_LT(area_at(0.0), 27.0);
}

TEST(Wild, MergesAcrossPrimitivesWithoutMixingTheirVertices) {
    const std::vector<float> values(81 * 2, 0.25f);
    const GeometryPtr one = withAttribute(*grid(8), "TEXCOORD_0", values);
    const GeometryPtr other = moved(grid(8), {0.5, 0.5, 1e-4});
    const ScenePtr scene = sceneWith({one, other});
    const LodSourcePtr source = wild(scene, {{"epsilon", 1.0}, {"scope", 1.0}});
    for (std::uint64_t p = 0; p < source->positionCount(); p += 3) {
        const Lod lod = source->readOut(p, nullptr);
        for (const GeometryPtr& geometry : lod.submeshes.front().primitives)
            for (const std::uint32_t index : geometry->indices)
                ASSERT_LT(index, geometry->positions.size());
    }
}

TEST(Wild, OneFaceStaysOfTwoOnTheSameVerticesOnlyWhereEitherSideShows) {
    // A closed tetrahedron flattens into two faces back to back; both are seen.
    const ScenePtr scene = sceneWith({sphere(3, 3, 0.0)});
    const LodSourcePtr source = wild(scene, {});
    const Lod last = source->readOut(source->positionCount() - 1, nullptr);
    EXPECT_GE(last.triangles, 2u);
}

TEST(Wild, InstancesWeighLikeCopies) {
    // Borders of a stretched instance count as they do once it is expanded.
    const InstanceWeights plain;
    EXPECT_EQ(plain.area(), glm::dmat3(1.0));
    std::mt19937 random(3);
    std::normal_distribution<double> entry;
    std::vector<glm::dmat3> parts(5);
    for (glm::dmat3& part : parts)
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
                part[c][r] = entry(random);
    const InstanceWeights weights(parts);
    const glm::dvec3 u(0.3, -0.2, 0.9);
    const glm::dvec3 v(-0.5, 0.4, 0.1);
    double literal = 0.0; // squared areas, instance by instance
    for (const glm::dmat3& part : parts) {
        const glm::dvec3 swept = glm::cross(part * u, part * v);
        literal += glm::dot(swept, swept);
    }
    const glm::dvec3 swept = glm::cross(u, v);
    const double closed = weights.scale() * glm::dot(swept, weights.area() * swept);
    EXPECT_NEAR(closed, literal, 1e-9 * literal);
}

TEST(Wild, DamagedMeshesReachAThousandth) { // a sample; lodestone_model_tests takes 200
    for (unsigned seed = 0; seed < 10; ++seed) {
        SCOPED_TRACE(seed);
        expectWildReachesAThousandth(
            sceneOf({submeshOf({damagedMesh(1000 + seed)})}, {{glm::dmat4(1.0)}}));
    }
}
