#pragma once
// The hole that a removed vertex leaves, in its best-fit plane.
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// A polygon seen along a normal.
struct FlatPolygon {
    std::vector<glm::dvec2> points; // counter-clockwise
};

// Triangulates a simple polygon by cutting the ear with the widest smallest angle, again and again.
// Appends points.size() - 2 triangles, indices into points, counter-clockwise; of each but the last
// the side from its third corner to its first is new. False if there is no ear left: the polygon is
// not simple. O(points^3), meant for a few dozen.
bool triangulate(const FlatPolygon& polygon, std::vector<Triangle>& triangles);

// Two axes across a unit normal, right-handed with it.
struct PlaneAxes {
    glm::dvec3 u{0.0};
    glm::dvec3 v{0.0};
};

PlaneAxes axesAcross(const glm::dvec3& normal);

} // namespace lodestone
