#pragma once
// Triangles by the cells of a dense grid that their boxes touch. Single precision: relative to a
// point among them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lodestone {

struct GridTriangle {
    std::array<glm::vec3, 3> corners{};
    std::uint32_t owner = 0;
};

class TriangleGrid {
public:
    TriangleGrid() = default;
    // About one cell a triangle. Those that would fill more than 1,000 cells are left out, as are
    // those that are not finite or farther out than 1e18.
    explicit TriangleGrid(std::vector<GridTriangle> triangles);

    bool empty() const { return entries_.empty(); }

    // Visits triangles among the first `count` that may be nearer to p than `reach`, those of the
    // nearer cells first; visit returns the reach from then on. Some come twice.
    template <class Visit>
    void visitNear(const glm::vec3& p, float reach, std::uint32_t count, Visit visit) const;

private:
    // A ball around a triangle.
    struct Ball {
        glm::vec3 center{0.0f};
        float radius = 0.0f;
    };

    glm::ivec3 cellOf(const glm::vec3& p) const {
        const glm::vec3 last(cells_ - 1);
        return glm::ivec3(glm::clamp((p - low_) * per_cell_, glm::vec3(0.0f), last));
    }

    std::size_t indexOf(int x, int y, int z) const {
        const auto wide = [](int i) { return static_cast<std::size_t>(i); };
        return (wide(z) * wide(cells_.y) + wide(y)) * wide(cells_.x) + wide(x);
    }

    void layOut();

    // Calls fill(triangle, cell) for all that are kept.
    template <class Fill>
    void forCells(Fill fill) const;

    std::vector<GridTriangle> triangles_;
    std::vector<Ball> balls_; // [triangles] radius < 0: left out
    glm::vec3 low_{0.0f};
    glm::vec3 high_{0.0f};
    float cell_ = 1.0f;
    float per_cell_ = 1.0f;
    glm::ivec3 cells_{1};
    std::vector<std::uint32_t> begin_;   // [cells + 1] into entries_
    std::vector<std::uint32_t> entries_; // triangles, rising within a cell
};

template <class Visit>
void TriangleGrid::visitNear(const glm::vec3& p,
                             float reach,
                             std::uint32_t count,
                             Visit visit) const {
    constexpr float kFar = 1e18f;
    if (empty() || !(glm::dot(p, p) < kFar * kFar) || !(reach < kFar))
        return;
    const auto visit_cell = [&](std::size_t cell) {
        for (std::uint32_t e = begin_[cell]; e < begin_[cell + 1] && entries_[e] < count; ++e) {
            const Ball& ball = balls_[entries_[e]];
            const glm::vec3 apart = p - ball.center;
            const float touching = reach + ball.radius;
            if (glm::dot(apart, apart) < touching * touching)
                reach = visit(triangles_[entries_[e]]);
        }
    };
    for (float radius = 0.5f * cell_;; radius *= 2.0f) {
        const float around = std::min(radius, reach);
        const glm::ivec3 low = cellOf(p - around);
        const glm::ivec3 high = cellOf(p + around);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    visit_cell(indexOf(x, y, z));
        if (around >= reach)
            return;
    }
}

} // namespace lodestone
