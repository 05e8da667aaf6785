#include "simplify/collapse/instance_weights.h"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

namespace lodestone {

namespace {

using Quadric4 = glm::dmat4;

// A submesh triangle and the instances that show it.
struct Sample {
    std::array<glm::dvec3, 3> corner;
    std::vector<glm::dmat4> transforms;

    std::vector<glm::dmat3> linearParts() const {
        std::vector<glm::dmat3> parts;
        for (const glm::dmat4& transform : transforms)
            parts.emplace_back(transform);
        return parts;
    }

    glm::dvec3 scaledNormal() const {
        return glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    }
};

Quadric4 planeQuadric(const glm::dvec3& normal, const glm::dvec3& point, double weight) {
    const glm::dvec4 plane(normal, -glm::dot(normal, point));
    return glm::outerProduct(plane, plane) * weight;
}

glm::dvec3 moved(const glm::dmat4& transform, const glm::dvec3& p) {
    return {transform * glm::dvec4(p, 1.0)};
}

// The paper's steps 1.a.i to iii: transform the triangle, make its quadric, pull that back.
Quadric4 literalFaces(const Sample& sample) {
    Quadric4 total(0.0);
    for (const glm::dmat4& transform : sample.transforms) {
        const glm::dvec3 a = moved(transform, sample.corner[0]);
        const glm::dvec3 cross = glm::cross(moved(transform, sample.corner[1]) - a,
                                            moved(transform, sample.corner[2]) - a);
        const double length = glm::length(cross);
        if (length > 0.0)
            total += glm::transpose(transform) * planeQuadric(cross / length, a, 0.5 * length) *
                     transform;
    }
    return total;
}

// The constraint plane through the instanced edge 0-1, perpendicular to the instanced face.
Quadric4 literalBorder(const Sample& sample, bool by_length) {
    Quadric4 total(0.0);
    for (const glm::dmat4& transform : sample.transforms) {
        const glm::dvec3 a = moved(transform, sample.corner[0]);
        const glm::dvec3 edge = moved(transform, sample.corner[1]) - a;
        const glm::dvec3 face = glm::cross(edge, moved(transform, sample.corner[2]) - a);
        const glm::dvec3 across = glm::cross(edge, face);
        if (!(glm::length(across) > 0.0))
            continue;
        const double length = glm::length(edge);
        total += glm::transpose(transform) *
                 planeQuadric(glm::normalize(across), a, by_length ? length : length * length) *
                 transform;
    }
    return total;
}

Quadric4 closedFaces(const Sample& sample, const InstanceWeights& weights) {
    const glm::dvec3 cross = sample.scaledNormal();
    const glm::dvec3 normal = glm::normalize(cross);
    return planeQuadric(normal,
                        sample.corner[0],
                        0.5 * glm::length(cross) * weights.face(normal) * weights.scale());
}

Quadric4 closedBorder(const Sample& sample, const InstanceWeights& weights, bool by_length) {
    std::vector<InstanceWeights::Plane> planes;
    weights.border(sample.corner[1] - sample.corner[0],
                   glm::normalize(sample.scaledNormal()),
                   by_length,
                   planes);
    Quadric4 total(0.0);
    for (const InstanceWeights::Plane& plane : planes)
        total += planeQuadric(plane.normal, sample.corner[0], plane.weight * weights.scale());
    return total;
}

double norm(const Quadric4& q) {
    double sum = 0.0;
    for (int column = 0; column < 4; ++column)
        sum += glm::dot(q[column], q[column]);
    return std::sqrt(sum);
}

double relativeDifference(const Quadric4& a, const Quadric4& b) {
    return norm(a - b) / std::max(norm(a), 1e-300);
}

class Maker {
public:
    explicit Maker(unsigned seed) : random_(seed) {}

    double number(double from, double to) {
        return std::uniform_real_distribution<double>(from, to)(random_);
    }

    glm::dvec3 vector(double reach) {
        const double x = number(-reach, reach);
        const double y = number(-reach, reach);
        return {x, y, number(-reach, reach)};
    }

    glm::dmat4 rotation() {
        const glm::dvec3 axis = vector(1.0);
        return glm::rotate(glm::dmat4(1.0), number(0.0, 6.0), glm::normalize(axis));
    }

    glm::dmat4 place(const glm::dmat4& linear) {
        return glm::translate(glm::dmat4(1.0), vector(3.0)) * linear;
    }

    glm::dmat4 similarity() {
        return place(rotation() * glm::scale(glm::dmat4(1.0), glm::dvec3(number(0.2, 3.0))));
    }

    glm::dmat4 scaled() { // never mirrored
        const double x = number(0.1, 2.0);
        const double y = number(0.1, 2.0);
        return place(rotation() * glm::scale(glm::dmat4(1.0), {x, y, number(0.1, 2.0)}));
    }

    glm::dmat4 mirrored() { return scaled() * glm::scale(glm::dmat4(1.0), {1.0, -1.0, 1.0}); }

    glm::dmat4 sheared() {
        glm::dmat4 shear(1.0);
        shear[1][0] = number(-1.5, 1.5);
        shear[2][1] = number(-1.5, 1.5);
        return scaled() * shear * rotation();
    }

    glm::dmat4 flattened() {
        return place(rotation() * glm::scale(glm::dmat4(1.0), {1.0, 0.7, 0.0}) * rotation());
    }

    Sample sample(std::vector<glm::dmat4> transforms) {
        const glm::dvec3 a = vector(1.0);
        const glm::dvec3 b = vector(1.0);
        return {{a, b, vector(1.0)}, std::move(transforms)};
    }

private:
    std::mt19937 random_;
};

using MakeTransform = glm::dmat4 (Maker::*)();

void expectLiteral(Maker& maker, int rounds, const std::vector<MakeTransform>& kinds, int each) {
    for (int round = 0; round < rounds; ++round) {
        std::vector<glm::dmat4> transforms;
        for (const MakeTransform kind : kinds)
            for (int i = 0; i < each; ++i)
                transforms.push_back((maker.*kind)());
        const Sample sample = maker.sample(transforms);
        const InstanceWeights weights(sample.linearParts());
        EXPECT_LT(relativeDifference(literalFaces(sample), closedFaces(sample, weights)), 1e-9);
        for (const bool by_length : {false, true})
            EXPECT_LT(relativeDifference(literalBorder(sample, by_length),
                                         closedBorder(sample, weights, by_length)),
                      1e-9)
                << "by length: " << by_length;
    }
}

} // namespace

TEST(InstanceWeights, EqualTheLoopForSimilarities) {
    Maker maker(1);
    expectLiteral(maker, 50, {&Maker::similarity}, 1);
    expectLiteral(maker, 20, {&Maker::similarity}, 200);
}

TEST(InstanceWeights, EqualTheLoopForNonUniformScales) {
    Maker maker(2);
    expectLiteral(maker, 50, {&Maker::scaled}, 1);
    expectLiteral(maker, 20, {&Maker::scaled}, 40);
}

TEST(InstanceWeights, EqualTheLoopForMirroredTransforms) {
    Maker maker(3);
    expectLiteral(maker, 50, {&Maker::mirrored}, 1);
    expectLiteral(maker, 20, {&Maker::mirrored}, 40);
}

TEST(InstanceWeights, EqualTheLoopForShearedTransforms) {
    Maker maker(4);
    expectLiteral(maker, 50, {&Maker::sheared}, 1);
    expectLiteral(maker, 20, {&Maker::sheared}, 40);
}

TEST(InstanceWeights, EqualTheLoopForAMixOfAllKinds) {
    Maker maker(5);
    expectLiteral(
        maker,
        40,
        {&Maker::similarity, &Maker::scaled, &Maker::mirrored, &Maker::sheared, &Maker::flattened},
        12);
}

TEST(InstanceWeights, OfASingularTransformAreZeroOnFacesAndTheLoopOnBorders) {
    Maker maker(6);
    for (int round = 0; round < 30; ++round) {
        const Sample sample = maker.sample({maker.flattened()});
        const InstanceWeights weights(sample.linearParts());
        EXPECT_LT(norm(closedFaces(sample, weights)), 1e-9);
        EXPECT_LT(
            relativeDifference(literalBorder(sample, false), closedBorder(sample, weights, false)),
            1e-9);
    }
}

TEST(InstanceWeights, EqualTheLoopForNearlyFlatTransforms) {
    Maker maker(7);
    for (int round = 0; round < 30; ++round) {
        const glm::dmat4 flat =
            maker.rotation() * glm::scale(glm::dmat4(1.0), {1.0, 0.8, 1e-4}) * maker.rotation();
        const Sample sample = maker.sample({flat});
        const InstanceWeights weights(sample.linearParts());
        EXPECT_LT(relativeDifference(literalFaces(sample), closedFaces(sample, weights)),
                  2e-8); // the loop itself loses digits
    }
}

TEST(InstanceWeights, AreZeroForVanishingTransforms) {
    const std::array parts{glm::dmat3(0.0), glm::dmat3(0.0)};
    const InstanceWeights weights(parts);
    EXPECT_EQ(weights.scale(), 0.0);
    EXPECT_EQ(weights.maxStretch(), 0.0);
    EXPECT_TRUE(std::isfinite(weights.face({0.0, 0.0, 1.0})));
}

TEST(InstanceWeights, OfAllSimilaritiesAreOneNumber) {
    Maker maker(8);
    std::vector<glm::dmat3> parts;
    double sum4 = 0.0;
    for (int i = 0; i < 1000; ++i) {
        parts.emplace_back(maker.similarity());
        sum4 += std::pow(glm::length(parts.back()[0]), 4.0);
    }
    const InstanceWeights weights(parts);
    EXPECT_TRUE(weights.uniform());
    EXPECT_NEAR(weights.scale() / sum4, 1.0, 1e-12);
}

TEST(InstanceWeights, MaxStretchIsTheLargestSingularValue) {
    Maker maker(9);
    const std::array parts{
        glm::dmat3(maker.similarity()),
        glm::dmat3(maker.rotation() * glm::scale(glm::dmat4(1.0), {0.1, 7.0, 0.3}) *
                   maker.rotation())};
    EXPECT_NEAR(InstanceWeights(parts).maxStretch(), 7.0, 1e-6);
}

// Above 64 groups W is tabulated: a hundredth or two off.
TEST(InstanceWeights, OfManyGroupsAreWithinTwoPercentOfTheLoop) {
    Maker maker(10);
    for (const int each : {30, 100, 1000}) {
        std::vector<glm::dmat4> transforms;
        for (int i = 0; i < each; ++i)
            for (const MakeTransform kind : {&Maker::similarity, &Maker::scaled, &Maker::sheared})
                transforms.push_back((maker.*kind)());
        const InstanceWeights weights(maker.sample(transforms).linearParts());
        for (int round = 0; round < 40; ++round) {
            const Sample sample = maker.sample(transforms);
            EXPECT_LT(relativeDifference(literalFaces(sample), closedFaces(sample, weights)), 0.02);
        }
    }
}

TEST(InstanceWeights, OfManyGroupsKeepBordersNearTheLoop) {
    Maker maker(11);
    std::vector<glm::dmat4> transforms;
    for (int i = 0; i < 300; ++i)
        for (const MakeTransform kind : {&Maker::similarity, &Maker::scaled, &Maker::sheared})
            transforms.push_back((maker.*kind)());
    const InstanceWeights weights(maker.sample(transforms).linearParts());
    for (int round = 0; round < 40; ++round) {
        const Sample sample = maker.sample(transforms);
        EXPECT_LT(
            relativeDifference(literalBorder(sample, false), closedBorder(sample, weights, false)),
            0.02);
        EXPECT_LT(
            relativeDifference(literalBorder(sample, true), closedBorder(sample, weights, true)),
            0.25);
    }
}

} // namespace lodestone
