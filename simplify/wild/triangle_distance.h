#pragma once
// How far two triangles are apart.
#include "simplify/measure/surface.h"

#include <optional>

namespace lodestone {

struct TriangleGap {
    double distance = 0.0;        // 0 where they touch or cross
    std::array<glm::dvec3, 2> at; // closest points: on the first, on the second
};

// Exact but for rounding; nothing if they are not nearer than `below`, which is found out fast.
// Triangles may have collapsed to segments or points.
std::optional<TriangleGap> triangleGap(const Triangle& a, const Triangle& b, double below);

} // namespace lodestone
