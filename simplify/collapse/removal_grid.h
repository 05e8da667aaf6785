#pragma once
#include "scene/scene.h"

#include <span>
#include <vector>

namespace lodestone {

// Distance of each point to the nearest of those before it; infinite for the first. bounds: of the
// points. Single precision inside the bounds. O(n) where they are spread evenly. Any thread.
std::vector<double> distancesToEarlier(std::span<const glm::dvec3> points, const Bounds& bounds);

} // namespace lodestone
