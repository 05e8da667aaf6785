#include "simplify/measure/triangle.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lodestone {

namespace {

// Plain, obtuse, thin, and collapsed to a segment and a point.
const std::vector<Triangle>& difficultTriangles() {
    static const std::vector<Triangle> triangles{
        {{{0, 0, 0}, {1, 0, 0.2}, {0.3, 1, 0}}},
        {{{0, 0, 0}, {1, 0, 0}, {-3, 0.5, 0.1}}},
        {{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-5, 0}}},
        {{{0, 0, 0}, {1, 0, 0}, {0.5, 1e-9, 0}}},
        {{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}},
        {{{2, 1, 0}, {2, 1, 0}, {2, 1, 0}}},
    };
    return triangles;
}

glm::dvec3 at(const Triangle& triangle, const glm::dvec3& weights) {
    return triangle[0] * weights.x + triangle[1] * weights.y + triangle[2] * weights.z;
}

} // namespace

TEST(Triangle, NoPointOfItIsCloserThanTheOneFound) {
    constexpr int kSteps = 40;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> around(-4.0, 4.0);
    for (std::size_t t = 0; t < difficultTriangles().size(); ++t) {
        const Triangle& triangle = difficultTriangles()[t];
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 point(around(random), around(random), around(random));
            const double found = std::sqrt(squaredDistance(point, triangle));
            for (int a = 0; a <= kSteps; ++a)
                for (int b = 0; a + b <= kSteps; ++b) {
                    const glm::dvec3 weights =
                        glm::dvec3(a, b, kSteps - a - b) / static_cast<double>(kSteps);
                    ASSERT_LE(found, glm::length(point - at(triangle, weights)) + 1e-9)
                        << "triangle " << t << ", point " << i;
                }
        }
    }
}

TEST(Triangle, TheWeightsAreOfAPointAtThatDistance) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> around(-4.0, 4.0);
    for (const Triangle& triangle : difficultTriangles())
        for (int i = 0; i < 300; ++i) {
            const glm::dvec3 point(around(random), around(random), around(random));
            const glm::dvec3 weights = closestWeights(point, triangle);
            EXPECT_GE(std::min({weights.x, weights.y, weights.z}), -1e-12);
            EXPECT_NEAR(weights.x + weights.y + weights.z, 1.0, 1e-12);
            EXPECT_NEAR(glm::length(point - at(triangle, weights)),
                        std::sqrt(squaredDistance(point, triangle)),
                        1e-6);
        }
}

} // namespace lodestone
