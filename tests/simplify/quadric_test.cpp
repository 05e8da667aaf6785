#include "simplify/collapse/quadric.h"

#include <glm/glm.hpp>
#include <gtest/gtest.h>
#include <random>
#include <vector>

namespace lodestone {

namespace {

struct Plane {
    glm::dvec3 normal{0.0};
    glm::dvec3 point{0.0};
    double weight = 0.0;
};

// What quadrics stand for, in double precision about the world's origin.
double reference(const std::vector<Plane>& planes, const glm::dvec3& at) {
    double sum = 0.0;
    for (const Plane& plane : planes) {
        const double distance = glm::dot(plane.normal, at - plane.point);
        sum += plane.weight * distance * distance;
    }
    return sum;
}

double weightOf(const std::vector<Plane>& planes) {
    double sum = 0.0;
    for (const Plane& plane : planes)
        sum += plane.weight;
    return sum;
}

Float3 toFloat(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

glm::dvec3 toDouble(Float3 v) {
    return {v.x, v.y, v.z};
}

Quadric localQuadric(const std::vector<Plane>& planes, const glm::dvec3& vertex) {
    Quadric quadric;
    for (const Plane& plane : planes)
        addSquare(quadric,
                  toFloat(plane.normal),
                  static_cast<float>(glm::dot(plane.normal, vertex - plane.point)),
                  static_cast<float>(plane.weight));
    return quadric;
}

class Maker {
public:
    explicit Maker(unsigned seed) : random_(seed) {}

    glm::dvec3 vector(double reach) {
        std::uniform_real_distribution<double> unit(-reach, reach);
        const double x = unit(random_);
        const double y = unit(random_);
        return {x, y, unit(random_)};
    }

    // Planes near a point, as those of faces around a vertex are.
    std::vector<Plane> planesNear(const glm::dvec3& center, int count) {
        std::vector<Plane> planes;
        for (int i = 0; i < count; ++i) {
            const glm::dvec3 normal = glm::normalize(vector(1.0));
            planes.push_back({normal, center + vector(0.1), 0.1 + std::abs(vector(1.0).x)});
        }
        return planes;
    }

private:
    std::mt19937 random_;
};

} // namespace

TEST(Quadric, EvaluatesLikeADoublePrecisionSumOfSquaredDistances) {
    Maker maker(1);
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 vertex = maker.vector(1.0);
        const std::vector<Plane> planes = maker.planesNear(vertex, 6);
        const Quadric quadric = localQuadric(planes, vertex);
        const glm::dvec3 offset = maker.vector(0.3);
        EXPECT_NEAR(evaluate(quadric, toFloat(offset)),
                    reference(planes, vertex + offset),
                    1e-6 * weightOf(planes));
    }
}

TEST(Quadric, TranslationChangesTheOriginAndNotTheError) {
    Maker maker(2);
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 vertex = maker.vector(1.0);
        const std::vector<Plane> planes = maker.planesNear(vertex, 6);
        const glm::dvec3 shift = maker.vector(0.3);
        const Quadric quadric = translated(localQuadric(planes, vertex), toFloat(shift));
        const glm::dvec3 offset = maker.vector(0.3);
        EXPECT_NEAR(evaluate(quadric, toFloat(offset)),
                    reference(planes, vertex + shift + offset),
                    1e-6 * weightOf(planes));
    }
}

TEST(Quadric, SumAboutTheMiddleIsTheSumOfBothErrors) {
    Maker maker(3);
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 a = maker.vector(1.0);
        const glm::dvec3 b = a + maker.vector(0.2);
        std::vector<Plane> planes = maker.planesNear(a, 5);
        const Quadric of_a = localQuadric(planes, a);
        const std::vector<Plane> others = maker.planesNear(b, 5);
        const Quadric of_b = localQuadric(others, b);
        planes.insert(planes.end(), others.begin(), others.end());
        const Quadric middle = sumAtMiddle(of_a, of_b, toFloat(0.5 * (b - a)));
        const glm::dvec3 offset = maker.vector(0.3);
        EXPECT_NEAR(evaluate(middle, toFloat(offset)),
                    reference(planes, 0.5 * (a + b) + offset),
                    1e-6 * weightOf(planes));
    }
}

// A quadric about the origin loses errors this small in cancellation.
TEST(Quadric, KeepsTinyErrorsOfFinelyMeshedSurfaces) {
    Maker maker(4);
    for (int round = 0; round < 100; ++round) {
        const glm::dvec3 vertex = maker.vector(1.0);
        std::vector<Plane> planes;
        planes.reserve(6);
        for (int i = 0; i < 6; ++i)
            planes.push_back(
                {glm::normalize(glm::dvec3(0.0, 0.0, 1.0) + maker.vector(1e-3)), vertex, 1e-6});
        const Quadric quadric = localQuadric(planes, vertex);
        const glm::dvec3 offset = maker.vector(1e-3) * glm::dvec3(1.0, 1.0, 1e-3);
        const double expected = reference(planes, vertex + offset);
        EXPECT_NEAR(evaluate(quadric, toFloat(offset)), expected, 1e-3 * expected + 1e-21);
    }
}

TEST(Quadric, PlacesAtTheMinimumOfTheError) {
    Maker maker(5);
    for (int round = 0; round < 200; ++round) {
        const glm::dvec3 corner = maker.vector(1.0);
        std::vector<Plane> planes;
        for (const glm::dvec3 normal :
             {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
            planes.push_back({glm::normalize(normal + maker.vector(0.2)), corner, 1.0});
        const glm::dvec3 a = corner + maker.vector(0.05);
        const glm::dvec3 b = corner + glm::normalize(maker.vector(1.0)) * 0.2;
        const Placement placement =
            placeEdge(localQuadric(planes, a), localQuadric(planes, b), toFloat(0.5 * (b - a)));
        const glm::dvec3 at = 0.5 * (a + b) + toDouble(placement.at);
        EXPECT_LT(glm::length(at - corner), 1e-3 * glm::length(b - a));
        EXPECT_NEAR(placement.cost, 0.0, 1e-5 * glm::dot(b - a, b - a));
    }
}

TEST(Quadric, PlacesTheMiddleOfAFlatOrStraightNeighbourhoodAtNoCost) {
    const std::vector<Plane> flat{{{0, 0, 1}, {0, 0, 0}, 1.0}};
    const glm::dvec3 a(0.2, 0.3, 0.0);
    const glm::dvec3 b(0.6, 0.3, 0.0);
    const Placement placement =
        placeEdge(localQuadric(flat, a), localQuadric(flat, b), toFloat(0.5 * (b - a)));
    EXPECT_NEAR(glm::length(toDouble(placement.at)), 0.0, 1e-6);
    EXPECT_NEAR(placement.cost, 0.0, 1e-9);
    const Placement empty = placeEdge({}, {}, toFloat(0.5 * (b - a)));
    EXPECT_EQ(glm::length(toDouble(empty.at)), 0.0);
    EXPECT_EQ(empty.cost, 0.0f);
}

TEST(Quadric, NeverPlacesFartherFromTheMiddleThanTheEdgeIsLong) {
    Maker maker(6);
    for (int round = 0; round < 500; ++round) {
        const glm::dvec3 a = maker.vector(1.0);
        const glm::dvec3 b = a + maker.vector(0.1);
        std::vector<Plane> planes; // nearly parallel: their meeting point is far away
        planes.reserve(5);
        for (int i = 0; i < 5; ++i)
            planes.push_back({glm::normalize(glm::dvec3(0.0, 0.0, 1.0) + maker.vector(0.02)),
                              a + maker.vector(0.1),
                              1.0});
        const Quadric of_a = localQuadric(planes, a);
        const Quadric of_b = localQuadric(planes, b);
        const Float3 half = toFloat(0.5 * (b - a));
        const Placement placement = placeEdge(of_a, of_b, half);
        EXPECT_LE(glm::length(toDouble(placement.at)), 1.0001 * glm::length(b - a));
        const Quadric middle = sumAtMiddle(of_a, of_b, half);
        for (const Float3 other : {half, half * -1.0f, Float3{}})
            EXPECT_LE(placement.cost, evaluate(middle, other) * 1.0001f + 1e-7f);
    }
}

} // namespace lodestone
