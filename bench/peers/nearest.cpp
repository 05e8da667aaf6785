#include "bench/peers/nearest.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>

namespace lodestone::bench {

int NearestPoint::axisOf(std::span<const std::uint32_t> range) const {
    glm::vec3 low(std::numeric_limits<float>::max());
    glm::vec3 high(std::numeric_limits<float>::lowest());
    for (const std::uint32_t index : range) {
        low = glm::min(low, points_[index]);
        high = glm::max(high, points_[index]);
    }
    const glm::vec3 size = high - low;
    if (size.x >= size.y && size.x >= size.z)
        return 0;
    return size.y >= size.z ? 1 : 2;
}

NearestPoint::NearestPoint(std::span<const glm::vec3> points)
    : points_(points), order_(points.size()), axes_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    const std::function<void(std::size_t, std::size_t)> split = [&](std::size_t begin,
                                                                    std::size_t end) {
        if (end - begin < 2)
            return;
        const int axis = axisOf(std::span(order_).subspan(begin, end - begin));
        const std::size_t middle = (begin + end) / 2;
        const auto at = [&](std::size_t place) {
            return order_.begin() + static_cast<std::ptrdiff_t>(place);
        };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            const float low = points_[a][axis];
            const float high = points_[b][axis];
            return low != high ? low < high : a < b;
        });
        axes_[middle] = static_cast<std::uint8_t>(axis);
        split(begin, middle);
        split(middle + 1, end);
    };
    split(0, order_.size());
}

void NearestPoint::search(const glm::vec3& point,
                          std::span<const std::uint32_t> range,
                          Best& best) const {
    if (range.empty())
        return;
    const std::size_t middle = range.size() / 2;
    const std::uint32_t index = range[middle];
    const glm::vec3 offset = points_[index] - point;
    const float squared = glm::dot(offset, offset);
    if (squared < best.squared_distance || (squared == best.squared_distance && index < best.index))
        best = {index, squared};
    const auto place = static_cast<std::size_t>(&range[middle] - order_.data());
    const float to_plane = point[axes_[place]] - points_[index][axes_[place]];
    const auto low = range.first(middle);
    const auto high = range.subspan(middle + 1);
    search(point, to_plane < 0.0F ? low : high, best);
    if (to_plane * to_plane <= best.squared_distance)
        search(point, to_plane < 0.0F ? high : low, best);
}

std::uint32_t NearestPoint::operator()(const glm::vec3& point) const {
    Best best{0, std::numeric_limits<float>::infinity()};
    search(point, order_, best);
    return best.index;
}

} // namespace lodestone::bench
