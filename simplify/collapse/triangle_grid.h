#pragma once
// Triangles by the cells of a dense grid that their boxes touch.
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace lodestone {

struct GridTriangle {
    std::array<glm::dvec3, 3> corners{};
    std::uint32_t owner = 0;
};

class TriangleGrid {
public:
    TriangleGrid() = default;
    // About one cell a triangle. Those that would fill more than 1,000 cells are left out, as are
    // those that are not finite.
    explicit TriangleGrid(std::vector<GridTriangle> triangles);

    bool empty() const { return entries_.empty(); }

    // Visits the triangles whose boxes may be within `reach` of p, the nearer cells first, until
    // nothing can be nearer than the square root of what visit returned. Some come twice.
    template <class Visit>
    void visitNear(const glm::dvec3& p, double reach, Visit visit) const;

private:
    glm::ivec3 cellOf(const glm::dvec3& p) const {
        const glm::dvec3 last(cells_ - 1);
        return glm::ivec3(glm::clamp((p - low_) / cell_, glm::dvec3(0.0), last));
    }

    std::size_t indexOf(int x, int y, int z) const {
        const auto wide = [](int i) { return static_cast<std::size_t>(i); };
        return (wide(z) * wide(cells_.y) + wide(y)) * wide(cells_.x) + wide(x);
    }

    // Calls fill(triangle, cell) for all that are kept.
    template <class Fill>
    void forCells(Fill fill) const;

    std::vector<GridTriangle> triangles_;
    glm::dvec3 low_{0.0};
    double cell_ = 1.0;
    glm::ivec3 cells_{1};
    std::vector<std::uint32_t> begin_;   // [cells + 1] into entries_
    std::vector<std::uint32_t> entries_; // triangles
};

template <class Visit>
void TriangleGrid::visitNear(const glm::dvec3& p, double reach, Visit visit) const {
    if (empty())
        return;
    double best2 = reach * reach;
    for (double radius = 0.5 * cell_;; radius *= 2.0) {
        const double around = radius < reach ? radius : reach;
        const glm::ivec3 low = cellOf(p - around);
        const glm::ivec3 high = cellOf(p + around);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (std::uint32_t e = begin_[indexOf(low.x, y, z)];
                     e < begin_[indexOf(high.x, y, z) + 1];
                     ++e)
                    best2 = visit(triangles_[entries_[e]]);
        if (around >= reach || best2 <= around * around)
            return;
    }
}

} // namespace lodestone
