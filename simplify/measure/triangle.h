#pragma once
// The closest point of one triangle, which may have collapsed to a segment or a point.
#include <array>
#include <glm/glm.hpp>

namespace lodestone {

using Triangle = std::array<glm::dvec3, 3>;

double squaredDistance(const glm::dvec3& point, const Triangle& triangle);

// Barycentric weights of the triangle's point that is closest to a point; in [0, 1], sum 1.
glm::dvec3 closestWeights(const glm::dvec3& point, const Triangle& triangle);

} // namespace lodestone
