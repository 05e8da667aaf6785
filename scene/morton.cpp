#include "scene/morton.h"

#include "scene/radix_sort.h"
#include "scene/scene.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

constexpr double kLastCell = 1023.0;

std::uint32_t spread(std::uint32_t v) { // 10 bits to every third bit
    v &= 0x3FF;
    v = (v | v << 16) & 0x30000FF;
    v = (v | v << 8) & 0x300F00F;
    v = (v | v << 4) & 0x30C30C3;
    return (v | v << 2) & 0x9249249;
}

// What is not a number goes into the first cell.
std::uint32_t cellOf(double at) {
    return static_cast<std::uint32_t>(at > 0.0 ? std::min(at, kLastCell) : 0.0);
}

} // namespace

std::vector<std::uint32_t> mortonOrder(std::span<const glm::dvec3> points) {
    Bounds bounds;
    for (const glm::dvec3& point : points)
        bounds.add(point);
    const glm::dvec3 size = bounds.size();
    const double longest = std::max({size.x, size.y, size.z});
    const double cells =
        longest > 0.0 && std::isfinite(longest) ? (kLastCell + 0.999) / longest : 0.0;
    std::vector<std::uint64_t> codes;
    codes.reserve(points.size());
    for (const glm::dvec3& point : points) {
        const glm::dvec3 cell = (point - bounds.min) * cells;
        const std::uint32_t code =
            spread(cellOf(cell.x)) | spread(cellOf(cell.y)) << 1 | spread(cellOf(cell.z)) << 2;
        codes.push_back(std::uint64_t{code} << 32 | codes.size());
    }
    sortByUpperHalf(codes);
    std::vector<std::uint32_t> order;
    order.reserve(codes.size());
    for (const std::uint64_t code : codes)
        order.push_back(static_cast<std::uint32_t>(code));
    return order;
}

} // namespace lodestone
