#pragma once
// How far two triangles are apart.
#include "simplify/measure/surface.h"

namespace lodestone {

struct TriangleGap {
    double distance = 0.0;        // 0 where they touch or cross
    std::array<glm::dvec3, 2> at; // closest points: on the first, on the second
};

// Exact but for rounding; triangles may have collapsed to segments or points.
TriangleGap triangleGap(const Triangle& a, const Triangle& b);

// Cheap: true only if they are farther apart than a distance, because a plane of one parts them.
bool surelyApart(const Triangle& a, const Triangle& b, double distance);

} // namespace lodestone
