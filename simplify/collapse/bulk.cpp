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
        // The median, then the tails on both sides of it.
        const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
        const auto tail = static_cast<std::ptrdiff_t>(values.size() / kTail);
        std::nth_element(values.begin(), middle, values.end());
        bulk.center[axis] = *middle;
        std::nth_element(values.begin(), values.begin() + tail, middle);
        std::nth_element(middle, values.end() - 1 - tail, values.end());
        const double low = *(values.begin() + tail);
        const double high = *(values.end() - 1 - tail);
        spread = std::max(spread, high - low);
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
