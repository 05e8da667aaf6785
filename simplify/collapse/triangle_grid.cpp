#include "simplify/collapse/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {

namespace {

bool finite(const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

} // namespace

TriangleGrid::TriangleGrid(std::vector<GridTriangle> triangles) : triangles_(std::move(triangles)) {
    std::erase_if(triangles_, [](const GridTriangle& triangle) {
        return !std::ranges::all_of(triangle.corners, finite);
    });
    if (triangles_.empty())
        return;
    low_ = triangles_.front().corners[0];
    glm::dvec3 high = low_;
    for (const GridTriangle& triangle : triangles_)
        for (const glm::dvec3& corner : triangle.corners) {
            low_ = glm::min(low_, corner);
            high = glm::max(high, corner);
        }
    const glm::dvec3 size = high - low_;
    const double longest = std::max({size.x, size.y, size.z, 1e-300});
    const auto most = static_cast<double>(triangles_.size()) + 1.0;
    cell_ = longest / std::min(most, 1000.0);
    const auto along = [&](double length) { return std::floor(length / cell_) + 1.0; };
    while (along(size.x) * along(size.y) * along(size.z) > most)
        cell_ *= 1.25;
    cells_ = glm::ivec3(along(size.x), along(size.y), along(size.z));
    begin_.assign(indexOf(0, 0, cells_.z) + 1, 0);
    forCells([&](std::uint32_t, std::size_t cell) { ++begin_[cell + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    entries_.resize(begin_.back());
    std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
    forCells([&](std::uint32_t triangle, std::size_t cell) { entries_[at[cell]++] = triangle; });
}

template <class Fill>
void TriangleGrid::forCells(Fill fill) const {
    constexpr int kMostCells = 1000;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        const auto& [a, b, c] = triangles_[t].corners;
        const glm::ivec3 low = cellOf(glm::min(a, glm::min(b, c)));
        const glm::ivec3 high = cellOf(glm::max(a, glm::max(b, c)));
        const glm::dvec3 count(high - low + 1);
        if (count.x * count.y * count.z > kMostCells)
            continue;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    fill(t, indexOf(x, y, z));
    }
}

} // namespace lodestone
