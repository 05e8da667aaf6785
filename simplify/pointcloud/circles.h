#pragma once
#include "simplify/pointcloud/methods.h"

namespace lodestone {

// Centre of the circle through the corners. Corners on a line: that of the smallest circle.
glm::dvec3 circumcentre(const Triangle3d& points);

// Centre of the smallest circle around the corners: the circumcentre of an acute triangle, else
// the middle of the longest side. Never outside the triangle.
glm::dvec3 smallestCircleCentre(const Triangle3d& points);

// One of the two.
glm::dvec3 triplexCentre(const Triangle3d& points, Fidelity fidelity);

} // namespace lodestone
