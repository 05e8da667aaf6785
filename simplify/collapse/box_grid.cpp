#include "simplify/collapse/box_grid.h"

#include <cmath>
#include <numeric>

namespace lodestone {

BoxGrid::BoxGrid(std::vector<Box> boxes) : boxes_(std::move(boxes)) {
    constexpr float kFar = 1e18f; // sizes and their squares stay finite
    std::vector<std::uint32_t> near;
    for (std::uint32_t b = 0; b < boxes_.size(); ++b) {
        const auto& [low, high] = boxes_[b];
        // A sum of all corners keeps what is not a number, as minimum and maximum may not.
        const glm::vec3 sum = glm::abs(low) + glm::abs(high);
        if (!(sum.x + sum.y + sum.z < kFar))
            continue;
        low_ = near.empty() ? low : glm::min(low_, low);
        high_ = near.empty() ? high : glm::max(high_, high);
        near.push_back(b);
    }
    if (!near.empty())
        layOut(near);
}

void BoxGrid::layOut(std::span<const std::uint32_t> near) {
    const glm::vec3 size = high_ - low_;
    const float longest = std::max({size.x, size.y, size.z, 1e-30f});
    const float most = static_cast<float>(near.size()) + 1.0f;
    cell_ = longest / std::min(most, 1000.0f);
    const auto along = [&](float length) { return std::floor(length / cell_) + 1.0f; };
    while (along(size.x) * along(size.y) * along(size.z) > most)
        cell_ *= 1.25f;
    per_cell_ = 1.0f / cell_;
    cells_ = glm::ivec3(along(size.x), along(size.y), along(size.z));
    begin_.assign(indexOf(0, 0, cells_.z) + 1, 0);
    std::vector<Cells> touched(boxes_.size());
    std::vector<std::uint32_t> narrow;
    for (const std::uint32_t b : near) {
        constexpr std::int64_t kMostCells = 1000;
        touched[b] = {cellOf(boxes_[b].low), cellOf(boxes_[b].high)};
        const glm::ivec3 count = touched[b].high - touched[b].low + 1; // at most 1,001 each
        const bool wide = std::int64_t{count.x} * count.y * count.z > kMostCells;
        (wide ? wide_ : narrow).push_back(b);
    }
    const auto for_cells = [&](auto fill) {
        for (const std::uint32_t b : narrow)
            for (int z = touched[b].low.z; z <= touched[b].high.z; ++z)
                for (int y = touched[b].low.y; y <= touched[b].high.y; ++y)
                    for (int x = touched[b].low.x; x <= touched[b].high.x; ++x)
                        fill(b, indexOf(x, y, z));
    };
    for_cells([&](std::uint32_t, std::size_t in) { ++begin_[in + 1]; });
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    entries_.resize(begin_.back());
    std::vector<std::uint32_t> at(begin_.begin(), begin_.end() - 1);
    for_cells([&](std::uint32_t box, std::size_t in) { entries_[at[in]++] = box; });
}

} // namespace lodestone
