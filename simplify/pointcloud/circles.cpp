#include "simplify/pointcloud/circles.h"

#include <cmath>

namespace lodestone {

namespace {

// Corner with the widest angle, opposite the longest side.
std::size_t widestCorner(const Triangle3d& points) {
    std::size_t widest = 0;
    double longest2 = -1.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 side = points[(k + 2) % 3] - points[(k + 1) % 3];
        if (glm::dot(side, side) > longest2) {
            longest2 = glm::dot(side, side);
            widest = k;
        }
    }
    return widest;
}

glm::dvec3 middleOfLongestSide(const Triangle3d& points) {
    const std::size_t k = widestCorner(points);
    return (points[(k + 1) % 3] + points[(k + 2) % 3]) * 0.5;
}

} // namespace

glm::dvec3 circumcentre(const Triangle3d& points) {
    constexpr double kFlat = 1e-12; // sine of an angle that counts as none
    const glm::dvec3 a = points[1] - points[0];
    const glm::dvec3 b = points[2] - points[0];
    const glm::dvec3 normal = glm::cross(a, b);
    const double normal2 = glm::dot(normal, normal);
    const double a2 = glm::dot(a, a);
    const double b2 = glm::dot(b, b);
    if (!(normal2 > kFlat * kFlat * a2 * b2))
        return middleOfLongestSide(points);
    return points[0] + glm::cross(a2 * b - b2 * a, normal) * (0.5 / normal2);
}

glm::dvec3 smallestCircleCentre(const Triangle3d& points) {
    const std::size_t k = widestCorner(points);
    const glm::dvec3 a = points[(k + 1) % 3] - points[k];
    const glm::dvec3 b = points[(k + 2) % 3] - points[k];
    return glm::dot(a, b) > 0.0 ? circumcentre(points) : middleOfLongestSide(points);
}

glm::dvec3 triplexCentre(const Triangle3d& points, Fidelity fidelity) {
    return fidelity == Fidelity::Literal ? circumcentre(points) : smallestCircleCentre(points);
}

} // namespace lodestone
