#include "render/smooth_normals.h"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace lodestone {
namespace {

glm::vec3 normalAt(const Geometry& geometry, std::size_t vertex) {
    const Attribute* normal = findAttribute(geometry.attributes, "NORMAL");
    return {attributeValue(*normal, vertex, 0),
            attributeValue(*normal, vertex, 1),
            attributeValue(*normal, vertex, 2)};
}

// Two squares that share the edge x = 0, the right one bent down; each with vertices of its own.
Geometry roof(double bend_rad) {
    const auto x = static_cast<float>(std::cos(bend_rad));
    const auto y = static_cast<float>(-std::sin(bend_rad));
    Geometry geometry;
    geometry.positions = {
        {-1, 0, 0}, {-1, 0, 1}, {0, 0, 1}, {0, 0, 0}, {0, 0, 0}, {0, 0, 1}, {x, y, 1}, {x, y, 0}};
    geometry.indices = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
    return geometry;
}

TEST(SmoothNormals, GentleEdgesAreSmoothedSharpOnesAreNot) {
    const Geometry gentle = withSmoothNormals(roof(0.7)); // 40 degrees
    ASSERT_EQ(gentle.positions.size(), 8u);
    for (std::size_t v = 0; v < 8; ++v) {
        const bool is_on_edge = gentle.positions[v].x == 0.0f;
        const double bend = is_on_edge ? 0.35 : gentle.positions[v].x < 0.0f ? 0.0 : 0.7;
        // The two triangles of a square meet the edge with different weights.
        const double tolerance = is_on_edge ? 0.15 : 1e-5;
        EXPECT_NEAR(normalAt(gentle, v).x, std::sin(bend), tolerance) << v;
        EXPECT_NEAR(normalAt(gentle, v).y, std::cos(bend), tolerance) << v;
    }
    const Geometry sharp = withSmoothNormals(roof(1.2)); // 69 degrees
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_NEAR(normalAt(sharp, v).x, v < 4 ? 0.0 : std::sin(1.2), 1e-5) << v;
}

TEST(SmoothNormals, BlocksThatAreNotWeldedStayApart) {
    Geometry blocks = roof(0.7);
    blocks.weld_blocks = {0, 4};
    const Geometry apart = withSmoothNormals(blocks);
    for (std::size_t v = 0; v < 8; ++v)
        EXPECT_NEAR(normalAt(apart, v).x, v < 4 ? 0.0 : std::sin(0.7), 1e-5) << v;
}

TEST(SmoothNormals, SharedCornersOfACubeAreSplitAndKeepTheirAttributes) {
    Geometry cube;
    for (unsigned v = 0; v < 8; ++v)
        cube.positions.emplace_back(v & 1u, v >> 1u & 1u, v >> 2u);
    cube.indices = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                    2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    Attribute number;
    number.semantic = "COLOR_0";
    number.type = ComponentType::UInt8;
    number.components = 4;
    for (std::size_t i = 0; i < 32; ++i)
        number.bytes.push_back(std::byte(i));
    cube.attributes.push_back(number);
    const Geometry split = withSmoothNormals(cube);
    EXPECT_EQ(split.positions.size(), 24u);
    ASSERT_EQ(split.indices.size(), cube.indices.size());
    for (std::size_t c = 0; c < split.indices.size(); ++c) {
        const std::uint32_t v = split.indices[c];
        EXPECT_EQ(split.positions[v], cube.positions[cube.indices[c]]);
        EXPECT_EQ(split.attributes[0].bytes[v * 4u], std::byte(cube.indices[c] * 4));
        const glm::vec3 normal = glm::abs(normalAt(split, v));
        EXPECT_NEAR(std::max({normal.x, normal.y, normal.z}), 1.0, 1e-6);
    }
}

TEST(SmoothNormals, SphereOfSeparateTrianglesIsRound) {
    constexpr unsigned kRings = 24;
    Geometry sphere;
    const auto point = [](unsigned ring, unsigned step) {
        const double polar = 3.14159265358979 * ring / kRings;
        const double around = 3.14159265358979 * (step % (2 * kRings)) / kRings;
        const bool is_pole = ring == 0 || ring == kRings;
        const double radius = is_pole ? 0.0 : std::sin(polar);
        return glm::vec3(radius * std::cos(around), std::cos(polar), -radius * std::sin(around));
    };
    const auto triangle = [&](const std::array<glm::vec3, 3>& corners) {
        for (const glm::vec3& corner : corners) {
            sphere.indices.push_back(static_cast<std::uint32_t>(sphere.positions.size()));
            sphere.positions.push_back(corner);
        }
    };
    for (unsigned r = 0; r < kRings; ++r)
        for (unsigned s = 0; s < 2 * kRings; ++s) { // degenerate ones at the poles included
            triangle({point(r, s), point(r + 1, s), point(r + 1, s + 1)});
            triangle({point(r, s), point(r + 1, s + 1), point(r, s + 1)});
        }
    const Geometry smooth = withSmoothNormals(sphere);
    for (std::size_t v = 0; v < smooth.positions.size(); ++v) {
        const glm::vec3 normal = normalAt(smooth, v);
        if (glm::length(normal) == 0.0f)
            continue; // of a degenerate triangle alone
        EXPECT_GT(glm::dot(normal, smooth.positions[v]), 0.99f);
    }
}

} // namespace
} // namespace lodestone
