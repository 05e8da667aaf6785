#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lodestone {

// Indices of points along a Morton curve (Morton 1966) over their bounds, 1,024 cells along the
// longest side: neighbours in the list are neighbours in space. Ties keep their order. O(points).
std::vector<std::uint32_t> mortonOrder(std::span<const glm::dvec3> points);

} // namespace lodestone
