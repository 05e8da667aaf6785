#include "simplify/bake/nearest_face.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>
#include <limits>
#include <random>

using namespace lodestone;
using namespace lodestone::meshes;

namespace {

std::vector<glm::vec3> cornersOf(const Complex& complex, const Submesh& submesh) {
    std::vector<glm::vec3> corners(complex.wedge_source.size());
    for (std::size_t p = 0; p + 1 < complex.wedge_begin.size(); ++p)
        for (std::uint32_t w = complex.wedge_begin[p]; w < complex.wedge_begin[p + 1]; ++w)
            corners[w] = submesh.primitives[p].geometry->positions[complex.wedge_source[w]];
    return corners;
}

// To a lattice of points on the triangle: never less than the distance, and hardly more.
float distanceTo(const glm::vec3& point, const std::array<glm::vec3, 3>& t) {
    constexpr int kSteps = 20;
    float least = std::numeric_limits<float>::infinity();
    for (int i = 0; i <= kSteps; ++i)
        for (int j = 0; i + j <= kSteps; ++j) {
            const float u = static_cast<float>(i) / kSteps;
            const float v = static_cast<float>(j) / kSteps;
            const glm::vec3 on = t[0] * (1.0f - u - v) + t[1] * u + t[2] * v;
            least = std::min(least, glm::length(point - on));
        }
    return least;
}

} // namespace

TEST(NearestFace, IsTheOneThatALoopOverAllFacesFinds) {
    const Submesh submesh = submeshOf({sphere(12, 16)});
    const Complex complex = buildComplex(submesh, {});
    const std::vector<glm::vec3> corners = cornersOf(complex, submesh);
    const NearestFace nearest(complex, corners);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> any(-1.5f, 1.5f);
    for (int i = 0; i < 60; ++i) {
        const glm::vec3 point(any(random), any(random), any(random));
        const auto cornersOfFace = [&](std::uint32_t face) {
            const auto& f = complex.faces[face];
            return std::array{corners[f[0]], corners[f[1]], corners[f[2]]};
        };
        float least = std::numeric_limits<float>::infinity();
        for (std::uint32_t face = 0; face < complex.faces.size(); ++face) {
            const auto t = cornersOfFace(face);
            if (glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), point) > 0.0f)
                least = std::min(least, distanceTo(point, t));
        }
        const std::uint32_t found = nearest.closest({point, point, 0});
        EXPECT_NEAR(distanceTo(point, cornersOfFace(found)), least, 0.01f);
    }
}

TEST(NearestFace, LooksTheSameWayAndPrefersItsOwnPart) {
    // Three sheets above each other; the uppermost looks down.
    const GeometryPtr sheet = grid(4);
    Geometry turned = *moved(sheet, {0.0, 0.0, 0.3});
    for (std::size_t i = 0; i + 2 < turned.indices.size(); i += 3)
        std::swap(turned.indices[i], turned.indices[i + 1]);
    const Submesh submesh =
        submeshOf({sheet, moved(sheet, {0.0, 0.0, 0.1}), std::make_shared<const Geometry>(turned)});
    const Complex complex = buildComplex(submesh, {});
    const NearestFace nearest(complex, cornersOf(complex, submesh));
    const glm::vec3 up(0.0f, 0.0f, 1.0f);
    const auto sheetOf = [&](float height, const glm::vec3& normal, std::size_t own) {
        return complex.primitiveOfFace(
            nearest.closest({{0.4f, 0.4f, height}, normal, complex.face_begin[own]}));
    };
    EXPECT_EQ(sheetOf(0.06f, up, 0), 0u);  // the other is nearer, but not by half
    EXPECT_EQ(sheetOf(0.08f, up, 0), 1u);  // now it is
    EXPECT_EQ(sheetOf(0.29f, up, 1), 1u);  // what is nearest looks down
    EXPECT_EQ(sheetOf(0.29f, -up, 1), 2u); // as the point does here
}
