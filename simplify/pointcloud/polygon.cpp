#include "simplify/pointcloud/polygon.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {

namespace {

double cross(const glm::dvec2& a, const glm::dvec2& b) {
    return a.x * b.y - a.y * b.x;
}

// Twice the signed area.
double areaOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return cross(b - a, c - a);
}

// Larger is better: twice the area over the sum of the squared sides, which falls with the
// smallest angle.
double shapeOf(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const double sides = glm::dot(b - a, b - a) + glm::dot(c - b, c - b) + glm::dot(a - c, a - c);
    return sides > 0.0 ? areaOf(a, b, c) / sides : 0.0;
}

} // namespace

bool triangulate(const FlatPolygon& polygon, std::vector<Triangle>& triangles) {
    constexpr double kLeastShape = 1e-6; // slimmer ears are none
    const std::vector<glm::dvec2>& at = polygon.points;
    std::vector<std::uint32_t> ring(at.size());
    std::iota(ring.begin(), ring.end(), 0u);
    while (ring.size() >= 3) {
        std::size_t best = ring.size();
        double best_shape = kLeastShape;
        for (std::size_t k = 0; k < ring.size(); ++k) {
            const std::uint32_t a = ring[(k + ring.size() - 1) % ring.size()];
            const std::uint32_t b = ring[k];
            const std::uint32_t c = ring[(k + 1) % ring.size()];
            const double shape = shapeOf(at[a], at[b], at[c]);
            if (shape <= best_shape)
                continue;
            const auto inside = [&](std::uint32_t p) {
                return p != a && p != b && p != c && areaOf(at[a], at[b], at[p]) >= 0.0 &&
                       areaOf(at[b], at[c], at[p]) >= 0.0 && areaOf(at[c], at[a], at[p]) >= 0.0;
            };
            if (std::ranges::any_of(ring, inside))
                continue;
            best = k;
            best_shape = shape;
        }
        if (best == ring.size())
            return false;
        triangles.push_back({ring[(best + ring.size() - 1) % ring.size()],
                             ring[best],
                             ring[(best + 1) % ring.size()]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(best));
    }
    return true;
}

PlaneAxes axesAcross(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    glm::dvec3 least(0.0);
    least[size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2] = 1.0;
    const glm::dvec3 u = glm::normalize(glm::cross(least, normal));
    return {u, glm::cross(normal, u)};
}

} // namespace lodestone
