#include "simplify/collapse/wedge_quadric.h"
#include "tests/simplify/meshes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lodestone {

namespace {

using meshes::readAt;
using meshes::sequenceOf;
using meshes::submeshOf;

// A fan of faces around the origin with two values a corner, as a wedge's quadric and as Hoppe
// wrote it: continuations n.x + d of every face, weights.
struct Fan {
    struct Plane {
        glm::dvec3 gradient{0.0};
        double offset = 0.0;
        double weight = 0.0;
    };

    std::vector<Plane> planes; // [faces * 2]
    Quadric quadric;           // of the vertex, relative to `center`
    Float3 center;

    // The least error at a place over all values of the wedge.
    double directError(const glm::dvec3& at) const {
        double error = 0.0;
        for (std::size_t value = 0; value < 2; ++value) {
            double mean = 0.0;
            double weight = 0.0;
            for (std::size_t i = value; i < planes.size(); i += 2) {
                mean += planes[i].weight * (glm::dot(planes[i].gradient, at) + planes[i].offset);
                weight += planes[i].weight;
            }
            mean /= weight;
            for (std::size_t i = value; i < planes.size(); i += 2) {
                const double d = glm::dot(planes[i].gradient, at) + planes[i].offset - mean;
                error += planes[i].weight * d * d;
            }
        }
        return error;
    }
};

glm::dvec3 toDouble(Float3 p) {
    return {p.x, p.y, p.z};
}

double squaredArea(const std::array<Float3, 3>& p) {
    const Float3 normal = cross(p[1] - p[0], p[2] - p[0]);
    return dot(normal, normal);
}

Fan randomFan(WedgeQuadrics& wedges, std::uint32_t wedge, std::mt19937& random) {
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    const auto point = [&] { return Float3{unit(random), unit(random), unit(random)}; };
    Fan fan;
    fan.center = point();
    const std::array<float, 2> own{unit(random), unit(random)};
    for (int f = 0; f < 5; ++f) {
        WedgeQuadrics::Face face;
        do // well-shaped: slivers are held back on purpose
            face.positions = {fan.center, point(), point()};
        while (squaredArea(face.positions) < 0.5);
        face.wedges = {wedge, 2, 3}; // the others are of no interest
        const std::array<float, 6> values{
            own[0], own[1], unit(random), unit(random), unit(random), unit(random)};
        for (std::uint32_t k = 0; k < 3; ++k)
            wedges.setValues(face.wedges[k], std::span(values).subspan(std::size_t{2} * k, 2));
        face.weight = 0.5f + 0.4f * unit(random);
        fan.quadric = sum(fan.quadric, wedges.addFace(face));
        const glm::dvec3 u = toDouble(face.positions[1] - face.positions[0]);
        const glm::dvec3 v = toDouble(face.positions[2] - face.positions[0]);
        const glm::dvec3 normal = glm::cross(u, v);
        for (std::size_t i = 0; i < 2; ++i) {
            const glm::dvec3 gradient =
                (glm::cross(v, normal) * static_cast<double>(values[2 + i] - values[i]) +
                 glm::cross(normal, u) * static_cast<double>(values[4 + i] - values[i])) /
                glm::dot(normal, normal);
            const double offset = values[i] - glm::dot(gradient, toDouble(fan.center));
            fan.planes.push_back({gradient, offset, face.weight});
        }
    }
    fan.quadric = difference(fan.quadric, wedges.finish(wedge));
    return fan;
}

// A square that bulges, one vertex a place; the value is a hump that the shape does not show.
GeometryPtr squareWithHump(std::string_view semantic, float size) {
    const GeometryPtr plain = meshes::grid(16);
    auto geometry = std::make_shared<Geometry>(*plain);
    const std::size_t components = semantic.starts_with("TEXCOORD") ? 2 : 3;
    std::vector<float> values;
    for (glm::vec3& p : geometry->positions) {
        const float hump =
            std::exp(-40.0f * glm::dot(p - glm::vec3(0.5f), p - glm::vec3(0.5f)) + 40.0f * 0.25f);
        values.insert(values.end(), {p.x + 0.2f * hump, p.y});
        if (components == 3)
            values.push_back(0.0f);
        p *= size;
    }
    return meshes::withAttribute(*geometry, std::string(semantic), values);
}

// The worst error of the texture coordinate over the places of the original vertices, by looking
// up the nearest vertex of the result in the plane: how far its value is from the hump's.
double worstValueError(const GeometryPtr& geometry, std::string_view semantic, float size) {
    const Attribute& attribute = *findAttribute(geometry->attributes, semantic);
    double worst = 0.0;
    for (std::size_t v = 0; v < geometry->positions.size(); ++v) {
        const glm::vec3 p = geometry->positions[v] / size;
        const float hump =
            std::exp(-40.0f * ((p.x - 0.5f) * (p.x - 0.5f) + (p.y - 0.5f) * (p.y - 0.5f)));
        worst =
            std::max<double>(worst, std::abs(attributeValue(attribute, v, 0) - p.x - 0.2f * hump));
    }
    return worst;
}

} // namespace

TEST(WedgeQuadrics, EqualHoppesErrorWithTheValueSolvedFor) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
    for (int round = 0; round < 20; ++round) {
        WedgeQuadrics wedges;
        wedges.reset(4, 2);
        const Fan fan = randomFan(wedges, 0, random);
        for (int probe = 0; probe < 5; ++probe) {
            const Float3 offset{unit(random), unit(random), unit(random)};
            const double expected = fan.directError(toDouble(fan.center + offset));
            EXPECT_NEAR(evaluate(fan.quadric, offset), expected, 0.02 * expected + 1e-5);
        }
    }
}

TEST(WedgeQuadrics, MergingAddsWhatTheUnionOfTheirFacesWouldCost) {
    std::mt19937 random(4);
    for (int round = 0; round < 20; ++round) {
        WedgeQuadrics wedges;
        wedges.reset(4, 2);
        const Fan a = randomFan(wedges, 0, random);
        const Fan b = randomFan(wedges, 1, random);
        const Float3 half = (b.center - a.center) * 0.5f;
        Quadric predicted = sumAtMiddle(a.quadric, b.quadric, half);
        wedges.addMerge(predicted, 0, 1, half);
        Fan both = a;
        both.planes.insert(both.planes.end(), b.planes.begin(), b.planes.end());
        const double expected = both.directError(toDouble(a.center + half));
        EXPECT_NEAR(predicted.c, expected, 0.02 * expected + 1e-5);

        wedges.move(0, half);
        wedges.move(1, half * -1.0f);
        const Quadric gained = wedges.merge(0, 1);
        EXPECT_NEAR(gained.c + translated(a.quadric, half).c +
                        translated(b.quadric, half * -1.0f).c,
                    predicted.c,
                    1e-3 * predicted.c + 1e-4);
    }
}

TEST(WedgeQuadrics, FourEdgesAtOnceEqualEachAlone) {
    std::mt19937 random(5);
    WedgeQuadrics wedges;
    wedges.reset(4, 2);
    const Fan a = randomFan(wedges, 0, random);
    const Fan b = randomFan(wedges, 1, random);
    const Float3 half = (b.center - a.center) * 0.5f;
    const Float4 zero{};
    QuadricOf<Float4> four;
    wedges.addMerges(four,
                     {0, 1, 0, 0},
                     {1, 0, 1, 0},
                     {half.x + zero, half.y + zero, half.z + zero},
                     Float4{1.0f, 1.0f, 0.0f, 1.0f});
    Quadric alone;
    wedges.addMerge(alone, 0, 1, half);
    EXPECT_FLOAT_EQ(four.xx[0], alone.xx);
    EXPECT_FLOAT_EQ(four.by[0], alone.by);
    EXPECT_FLOAT_EQ(four.c[0], alone.c);
    EXPECT_EQ(four.c[2], 0.0f); // nothing to merge
}

TEST(WedgeQuadrics, SliversHaveNoSayAcrossTheirHeight) {
    WedgeQuadrics wedges;
    wedges.reset(3, 1);
    WedgeQuadrics::Face face;
    face.positions = {Float3{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}, {0.5f, 1e-9f, 0.0f}};
    face.wedges = {0, 1, 2};
    wedges.setValues(2, std::array{1.0f});
    face.weight = 1.0f;
    EXPECT_LT(wedges.addFace(face).yy, 1.0f);
}

TEST(WedgeQuadrics, TextureThatTheShapeDoesNotShowIsKeptWhereItBends) {
    CollapseOptions without;
    without.attributes = {0.0, 0.0, 0.0};
    for (const float size : {1.0f, 1e-3f, 1e4f}) { // whatever the units
        const Submesh submesh = submeshOf({squareWithHump("TEXCOORD_0", size)});
        const auto error_of = [&](const CollapseOptions& options) {
            const CollapseSequence sequence = sequenceOf(submesh, options);
            std::uint32_t step = 0;
            while (sequence.facesAt(step) > 60)
                ++step;
            return worstValueError(readAt(sequence, submesh, step)[0], "TEXCOORD_0", size);
        };
        EXPECT_LT(error_of({}), 0.03) << size;
        EXPECT_LT(error_of({}), 0.5 * error_of(without)) << size;
    }
}

TEST(WedgeQuadrics, WeightsOfZeroLeaveTheShapeAlone) {
    CollapseOptions without;
    without.attributes = {0.0, 0.0, 0.0};
    const GeometryPtr plain = meshes::sphere(12, 16);
    std::vector<float> texcoords;
    for (const glm::vec3& p : plain->positions)
        texcoords.insert(texcoords.end(), {p.x * p.y, p.z});
    const Submesh textured = submeshOf({meshes::withAttribute(*plain, "TEXCOORD_0", texcoords)});
    const Submesh bare = submeshOf({plain});
    const CollapseSequence of_textured = sequenceOf(textured, without);
    const CollapseSequence of_bare = sequenceOf(bare);
    EXPECT_EQ(of_textured.cost, of_bare.cost);
    EXPECT_EQ(of_textured.version_position, of_bare.version_position);
}

TEST(WedgeQuadrics, ErrorAsADistanceLeavesAttributesOut) {
    const Submesh submesh = submeshOf({squareWithHump("TEXCOORD_0", 1.0f)});
    const CollapseSequence sequence = sequenceOf(submesh);
    std::uint32_t step = 0;
    while (sequence.facesAt(step) > 60)
        ++step;
    EXPECT_GT(sequence.cost[step - 1], 1e-8);
    EXPECT_LT(sequence.error[step - 1], 1e-4f); // flat all along
}

TEST(WedgeQuadrics, NonsenseInAttributesDoesNotReachPositions) {
    const GeometryPtr plain = meshes::sphere(8, 10);
    std::vector<float> texcoords;
    for (std::size_t v = 0; v < plain->positions.size(); ++v)
        texcoords.insert(texcoords.end(), {v % 3 == 0 ? NAN : 1e30f, v % 5 == 0 ? INFINITY : 0.0f});
    const Submesh submesh = submeshOf({meshes::withAttribute(*plain, "TEXCOORD_0", texcoords)});
    const CollapseSequence sequence = sequenceOf(submesh);
    for (std::uint32_t step = 0; step <= sequence.step_count; ++step)
        EXPECT_TRUE(meshes::shapeOf(readAt(sequence, submesh, step)).finite);
}

} // namespace lodestone
