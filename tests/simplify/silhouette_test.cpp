#include "tests/simplify/meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

constexpr int kSide = 160; // pixels of an outline's picture, which shows -1.6..1.6

// Which pixels a mesh covers, seen along -z after a turn.
std::vector<bool> outline(const Geometry& geometry, const glm::dmat3& turn) {
    std::vector<bool> covered(std::size_t{kSide} * kSide, false);
    const auto pixel = [&](std::uint32_t index) {
        const glm::dvec3 seen = turn * glm::dvec3(geometry.positions[index]);
        return (glm::dvec2(seen) / 3.2 + 0.5) * double(kSide);
    };
    const auto twice = [](const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    for (std::size_t f = 0; f + 2 < geometry.indices.size(); f += 3) {
        const glm::dvec2 a = pixel(geometry.indices[f]);
        const glm::dvec2 b = pixel(geometry.indices[f + 1]);
        const glm::dvec2 c = pixel(geometry.indices[f + 2]);
        if (twice(a, b, c) <= 0.0)
            continue; // the front alone covers a closed mesh
        const glm::dvec2 low = glm::max(glm::min(a, glm::min(b, c)), glm::dvec2(0.0));
        const glm::dvec2 high =
            glm::min(glm::max(a, glm::max(b, c)), glm::dvec2(double(kSide) - 1.0));
        for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y)
            for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
                const glm::dvec2 p(x + 0.5, y + 0.5);
                if (twice(a, b, p) >= 0.0 && twice(b, c, p) >= 0.0 && twice(c, a, p) >= 0.0)
                    covered[static_cast<std::size_t>(y * kSide + x)] = true;
            }
    }
    return covered;
}

// Mean share of the outline's pixels that differ, over directions all around.
double outlineError(const Geometry& mesh, const Geometry& lod) {
    double sum = 0.0;
    int directions = 0;
    for (const double up : {-0.9, 0.0, 0.9})
        for (int around = 0; around < 8; ++around) {
            const glm::dmat4 turn =
                glm::rotate(glm::rotate(glm::dmat4(1.0), up, glm::dvec3(1.0, 0.0, 0.0)),
                            around * std::numbers::pi / 4.0,
                            glm::dvec3(0.0, 1.0, 0.0));
            const std::vector<bool> was = outline(mesh, glm::dmat3(turn));
            const std::vector<bool> is = outline(lod, glm::dmat3(turn));
            std::size_t differ = 0;
            for (std::size_t i = 0; i < was.size(); ++i)
                differ += was[i] != is[i] ? 1 : 0;
            sum += static_cast<double>(differ) / static_cast<double>(std::ranges::count(was, true));
            ++directions;
        }
    return sum / directions;
}

double errorWith(double silhouette_weight, const GeometryPtr& mesh, std::uint32_t faces) {
    const Submesh submesh = meshes::submeshOf({mesh});
    CollapseOptions options;
    options.silhouette_weight = silhouette_weight;
    const CollapseSequence sequence = meshes::sequenceOf(submesh, options);
    std::uint32_t step = 0;
    std::vector<GeometryPtr> lod = meshes::readAt(sequence, submesh, step);
    while (lod[0]->triangleCount() > faces)
        lod = meshes::readAt(sequence, submesh, ++step);
    return outlineError(*mesh, *lod[0]);
}

// A sphere with shallow waves inside its outline and a sharp rim around it: where the rim pays
// for the waves' triangles the outline suffers.
GeometryPtr wavyLens() {
    auto lens = std::make_shared<Geometry>(*meshes::sphere(24, 48, 0.0));
    for (glm::vec3& p : lens->positions) {
        const float radius = std::min(std::hypot(p.x, p.y), 1.0f);
        const float side = p.z < 0.0f ? -1.0f : 1.0f;
        p.z = side * (0.35f * (1.0f - radius) +
                      0.03f * (1.0f - radius) * std::sin(14.0f * p.x) * std::sin(14.0f * p.y));
    }
    return lens;
}

TEST(Silhouette, ItsWeightKeepsTheOutlineAtEqualTriangles) {
    const GeometryPtr lens = wavyLens();
    const double plain = errorWith(0.0, lens, 120);
    const double weighted = errorWith(1.0, lens, 120);
    EXPECT_LT(weighted, 0.9 * plain);
}

TEST(Silhouette, AFlatSurfaceHasNone) {
    const Submesh submesh = meshes::submeshOf({meshes::grid(12)});
    CollapseOptions options;
    const CollapseSequence plain = meshes::sequenceOf(submesh, options);
    options.silhouette_weight = 100.0;
    const CollapseSequence weighted = meshes::sequenceOf(submesh, options);
    for (const std::uint32_t step : {20u, 60u, 100u})
        EXPECT_EQ(meshes::readAt(plain, submesh, step)[0]->positions,
                  meshes::readAt(weighted, submesh, step)[0]->positions);
}

} // namespace
} // namespace lodestone
