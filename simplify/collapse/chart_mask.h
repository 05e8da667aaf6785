#pragma once
// Which part of a texture a mesh shows.
#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lodestone {

class ChartMask {
public:
    using Triangle = std::array<glm::vec2, 3>; // texture coordinates

    ChartMask() = default; // holds everything
    // Of all charts together, on a grid over their box of 16 + 2 sqrt(triangles) cells a side, 128
    // at most, a cell wider all around: textures are padded. Triangles that are not finite do not
    // count. A tiled texture, on which triangles lie on each other many times over, has no charts:
    // all of it is held. O(triangles + cells).
    explicit ChartMask(std::span<const Triangle> triangles);

    // Whether it holds some things and others not.
    bool covers() const { return !cells_.empty(); }

    bool holds(glm::vec2 at) const {
        if (cells_.empty())
            return true;
        const glm::vec2 cell = (at - low_) * cells_per_unit_;
        const auto most = static_cast<float>(side_);
        if (!(cell.x >= 0.0f && cell.y >= 0.0f && cell.x < most && cell.y < most))
            return false;
        return cells_[static_cast<std::size_t>(cell.y) * side_ +
                      static_cast<std::size_t>(cell.x)] != 0;
    }

private:
    std::size_t stepsOf(const Triangle& triangle) const;
    bool isTiled(std::span<const Triangle> triangles) const;
    void fill(const Triangle& triangle);
    void widen();

    glm::vec2 low_{0.0f};
    glm::vec2 cells_per_unit_{0.0f};
    std::size_t side_ = 0;
    std::vector<char> cells_; // [side * side] or empty
};

} // namespace lodestone
