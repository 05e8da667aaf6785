#pragma once
// Boxes by the cells of a dense grid that they touch. Single precision: relative to a point among
// them.
#include "simplify/collapse/box.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone {

class BoxGrid {
public:
    BoxGrid() = default;
    // About one cell a box. Boxes that are not finite or reach farther out than 1e18 are left out.
    explicit BoxGrid(std::vector<Box> boxes);

    bool empty() const { return entries_.empty() && wide_.empty(); }

    // Visits boxes among the first `count` that may be nearer to p than `reach`, those of the
    // nearer cells first; visit(index) returns the reach from then on. Some come twice.
    template <class Visit>
    void visitNear(const glm::vec3& p, float reach, std::uint32_t count, Visit visit) const;

private:
    struct Cells { // inclusive
        glm::ivec3 low{0};
        glm::ivec3 high{0};
    };

    glm::ivec3 cellOf(const glm::vec3& p) const {
        const glm::vec3 last(cells_ - 1);
        return glm::ivec3(glm::clamp((p - low_) * per_cell_, glm::vec3(0.0f), last));
    }

    std::size_t indexOf(int x, int y, int z) const {
        const auto wide = [](int i) { return static_cast<std::size_t>(i); };
        return (wide(z) * wide(cells_.y) + wide(y)) * wide(cells_.x) + wide(x);
    }

    void layOut(std::span<const std::uint32_t> near);

    std::vector<Box> boxes_;
    glm::vec3 low_{0.0f};
    glm::vec3 high_{0.0f};
    float cell_ = 1.0f;
    float per_cell_ = 1.0f;
    glm::ivec3 cells_{1};
    std::vector<std::uint32_t> begin_;   // [cells + 1] into entries_
    std::vector<std::uint32_t> entries_; // boxes, rising within a cell
    std::vector<std::uint32_t> wide_;    // boxes that touch very many cells, rising
};

template <class Visit>
void BoxGrid::visitNear(const glm::vec3& p, float reach, std::uint32_t count, Visit visit) const {
    constexpr float kFar = 1e18f;
    if (empty() || !(glm::dot(p, p) < kFar * kFar) || !(reach < kFar))
        return;
    const auto visit_box = [&](std::uint32_t index) {
        if (boxes_[index].squaredDistance(p) < reach * reach)
            reach = visit(index);
    };
    for (std::size_t i = 0; i < wide_.size() && wide_[i] < count; ++i)
        visit_box(wide_[i]);
    for (float radius = 0.5f * cell_;; radius *= 2.0f) {
        const float around = std::min(radius, reach);
        const glm::ivec3 low = cellOf(p - around);
        const glm::ivec3 high = cellOf(p + around);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const std::size_t cell = indexOf(x, y, z);
                    for (std::uint32_t e = begin_[cell];
                         e < begin_[cell + 1] && entries_[e] < count;
                         ++e)
                        visit_box(entries_[e]);
                }
        if (around >= reach)
            return;
    }
}

} // namespace lodestone
