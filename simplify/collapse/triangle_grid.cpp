#include "simplify/collapse/triangle_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {

TriangleGrid::TriangleGrid(std::vector<GridTriangle> triangles) : triangles_(std::move(triangles)) {
    constexpr float kFar = 1e18f; // sizes and their squares stay finite
    balls_.reserve(triangles_.size());
    bool any = false;
    for (const GridTriangle& triangle : triangles_) {
        const auto& [a, b, c] = triangle.corners;
        const glm::vec3 low = glm::min(a, glm::min(b, c));
        const glm::vec3 high = glm::max(a, glm::max(b, c));
        const glm::vec3 center = (low + high) * 0.5f;
        const float radius = 0.5f * glm::length(high - low);
        // A sum of all corners keeps what is not a number, as minimum and maximum may not.
        const glm::vec3 sum = glm::abs(a) + glm::abs(b) + glm::abs(c);
        const bool near = sum.x + sum.y + sum.z < kFar;
        balls_.push_back({center, near ? radius : -1.0f});
        if (!near)
            continue;
        low_ = any ? glm::min(low_, low) : low;
        high_ = any ? glm::max(high_, high) : high;
        any = true;
    }
    if (any)
        layOut();
}

void TriangleGrid::layOut() {
    const glm::vec3 size = high_ - low_;
    const float longest = std::max({size.x, size.y, size.z, 1e-30f});
    const float most = static_cast<float>(triangles_.size()) + 1.0f;
    cell_ = longest / std::min(most, 1000.0f);
    const auto along = [&](float length) { return std::floor(length / cell_) + 1.0f; };
    while (along(size.x) * along(size.y) * along(size.z) > most)
        cell_ *= 1.25f;
    per_cell_ = 1.0f / cell_;
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
    constexpr std::int64_t kMostCells = 1000;
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        if (balls_[t].radius < 0.0f)
            continue;
        const auto& [a, b, c] = triangles_[t].corners;
        const glm::ivec3 low = cellOf(glm::min(a, glm::min(b, c)));
        const glm::ivec3 high = cellOf(glm::max(a, glm::max(b, c)));
        const glm::ivec3 count = high - low + 1; // at most 1,001 each
        if (std::int64_t{count.x} * count.y * count.z > kMostCells)
            continue;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    fill(t, indexOf(x, y, z));
    }
}

} // namespace lodestone
