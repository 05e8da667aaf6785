#include "simplify/shape_floor.h"

#include <algorithm>

namespace lodestone {

void ShapeMeasure::add(const std::array<glm::dvec3, 3>& corners) {
    for (const glm::dvec3& corner : corners)
        bounds.add(corner);
    area += 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

bool keepsShape(const ShapeMeasure& now, const ShapeMeasure& whole, const ShapeShares& shares) {
    if (now.area < shares.area * whole.area)
        return false;
    const glm::dvec3 size = whole.bounds.size();
    const glm::dvec3 left = now.bounds.size();
    const double slack = 1e-9 * whole.bounds.diagonal();
    for (int axis = 0; axis < 3; ++axis) {
        const bool thin = 4.0 * size[axis] < std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]);
        if (!thin && left[axis] + slack < shares.extent * size[axis])
            return false;
    }
    return true;
}

} // namespace lodestone
