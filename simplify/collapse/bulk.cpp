#include "simplify/collapse/bulk.h"

#include <algorithm>
#include <vector>

namespace lodestone {

Bulk findBulk(std::span<const glm::vec3> points) {
    constexpr double kReach = 1e4; // x the spread: beyond it single precision shows
    constexpr std::size_t kTail = 20;
    if (points.size() < kTail) // too few to tell which are out
        return {};
    const std::size_t stride = points.size() / 4096 + 1;
    Bulk bulk;
    double spread = 0.0;
    std::vector<float> values;
    for (int axis = 0; axis < 3; ++axis) {
        values.clear();
        for (std::size_t i = 0; i < points.size(); i += stride)
            values.push_back(points[i][axis]);
        std::ranges::sort(values);
        const std::size_t tail = values.size() / kTail;
        bulk.center[axis] = values[values.size() / 2];
        spread =
            std::max(spread, static_cast<double>(values[values.size() - 1 - tail]) - values[tail]);
    }
    if (!(spread > 0.0))
        return {};
    const double reach = kReach * spread;
    const auto within = [&](const glm::vec3& p) {
        return glm::length(glm::dvec3(p) - bulk.center) <= reach;
    };
    if (!std::ranges::all_of(points, within))
        bulk.reach = reach;
    return bulk;
}

} // namespace lodestone
