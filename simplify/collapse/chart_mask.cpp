#include "simplify/collapse/chart_mask.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

constexpr std::size_t kMargin = 1; // cells

std::size_t sideFor(std::size_t triangle_count) {
    constexpr double kMost = 128.0;
    const double side = 16.0 + 2.0 * std::sqrt(static_cast<double>(triangle_count));
    return static_cast<std::size_t>(std::min(side, kMost));
}

bool isFinite(const ChartMask::Triangle& triangle) {
    return std::ranges::all_of(
        triangle, [](glm::vec2 at) { return std::isfinite(at.x) && std::isfinite(at.y); });
}

} // namespace

ChartMask::ChartMask(std::span<const Triangle> triangles) {
    glm::vec2 high(0.0f);
    bool any = false;
    for (const Triangle& triangle : triangles)
        for (const glm::vec2 at :
             isFinite(triangle) ? std::span(triangle) : std::span<const glm::vec2>()) {
            low_ = any ? glm::min(low_, at) : at;
            high = any ? glm::max(high, at) : at;
            any = true;
        }
    const glm::vec2 size = high - low_;
    if (!(size.x > 0.0f) || !(size.y > 0.0f) || !std::isfinite(size.x) || !std::isfinite(size.y))
        return; // all on one line of texels
    // The margin and half a cell stay free at every side.
    side_ = sideFor(triangles.size());
    const auto inner = static_cast<float>(side_ - 2 * kMargin - 1);
    cells_per_unit_ = glm::vec2(inner) / size;
    low_ -= (static_cast<float>(kMargin) + 0.5f) / cells_per_unit_;
    if (isTiled(triangles))
        return;
    cells_.assign(side_ * side_, 0);
    for (const Triangle& triangle : triangles)
        if (isFinite(triangle))
            fill(triangle);
    widen();
}

// How often a triangle's sides are divided, so that its points lie less than a cell apart.
std::size_t ChartMask::stepsOf(const Triangle& triangle) const {
    const glm::vec2 u = (triangle[1] - triangle[0]) * cells_per_unit_;
    const glm::vec2 v = (triangle[2] - triangle[0]) * cells_per_unit_;
    const glm::vec2 longest = glm::max(glm::max(glm::abs(u), glm::abs(v)), glm::abs(u - v));
    return static_cast<std::size_t>(std::ceil(std::max(longest.x, longest.y))) + 1;
}

// Whether triangles lie on each other many times over, as on a texture that is tiled.
bool ChartMask::isTiled(std::span<const Triangle> triangles) const {
    constexpr std::size_t kMostLayers = 16;
    std::size_t points = 0;
    for (const Triangle& triangle : triangles)
        if (isFinite(triangle)) {
            const std::size_t steps = stepsOf(triangle);
            points += steps * steps / 2;
        }
    return points > kMostLayers * side_ * side_ + 4 * triangles.size();
}

// What its points miss at the rim widen() adds.
void ChartMask::fill(const Triangle& triangle) {
    const glm::vec2 from = (triangle[0] - low_) * cells_per_unit_;
    const glm::vec2 u = (triangle[1] - triangle[0]) * cells_per_unit_;
    const glm::vec2 v = (triangle[2] - triangle[0]) * cells_per_unit_;
    const std::size_t steps = stepsOf(triangle);
    const float step = 1.0f / static_cast<float>(steps);
    for (std::size_t i = 0; i <= steps; ++i)
        for (std::size_t k = 0; k + i <= steps; ++k) {
            const glm::vec2 at =
                from + (u * static_cast<float>(i) + v * static_cast<float>(k)) * step;
            const auto x = std::min(static_cast<std::size_t>(std::max(at.x, 0.0f)), side_ - 1);
            const auto y = std::min(static_cast<std::size_t>(std::max(at.y, 0.0f)), side_ - 1);
            cells_[y * side_ + x] = 1;
        }
}

void ChartMask::widen() {
    std::vector<char> row(side_);
    const auto pass = [&](std::size_t first, std::size_t apart) {
        for (std::size_t i = 0; i < side_; ++i) {
            const std::size_t begin = i - std::min(i, kMargin);
            const std::size_t end = std::min(i + kMargin + 1, side_);
            row[i] = 0;
            for (std::size_t k = begin; k < end; ++k)
                row[i] = static_cast<char>(row[i] | cells_[first + k * apart]);
        }
        for (std::size_t i = 0; i < side_; ++i)
            cells_[first + i * apart] = row[i];
    };
    for (std::size_t i = 0; i < side_; ++i)
        pass(i * side_, 1);
    for (std::size_t i = 0; i < side_; ++i)
        pass(i, side_);
}

} // namespace lodestone
