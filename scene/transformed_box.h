#pragma once
#include "scene/scene.h"

namespace lodestone {

// The box around a transformed box; box: not empty.
inline Bounds transformedBox(const glm::dmat4& transform, const Bounds& box) {
    const glm::dvec3 center(transform * glm::dvec4(box.center(), 1.0));
    const glm::dvec3 half = box.size() * 0.5;
    glm::dvec3 reach(0.0);
    for (int axis = 0; axis < 3; ++axis)
        reach += glm::abs(glm::dvec3(transform[axis])) * half[axis];
    Bounds bounds;
    bounds.add(center - reach);
    bounds.add(center + reach);
    return bounds;
}

} // namespace lodestone
