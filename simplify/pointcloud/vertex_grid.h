#pragma once
// A spatial hash of vertices for balls of one radius, out of which vertices are taken.
#include "scene/scene.h"

#include <array>

namespace lodestone {

class VertexGrid {
public:
    // positions: finite, outlive the grid; those left out are not in it. radius > 0. O(vertices).
    VertexGrid(std::span<const glm::dvec3> positions,
               const std::vector<bool>& left_out,
               double radius);

    // Takes out the vertices that are nearer to `centre` than the radius and appends them to `out`,
    // nearest cells in a fixed order. O(vertices in the up to 8 cells around).
    void takeWithin(const glm::dvec3& centre, std::vector<std::uint32_t>& out);

private:
    using Cell = std::array<double, 3>; // whole numbers; doubles hold those of far outliers, too

    Cell cellOf(const glm::dvec3& point) const;
    std::size_t bucketOf(const Cell& cell) const;
    void takeFrom(const Cell& cell, const glm::dvec3& centre, std::vector<std::uint32_t>& out);

    std::span<const glm::dvec3> positions_;
    double radius_;
    double cell_size_;                 // twice the radius: a ball touches at most 2 x 2 x 2 cells
    std::vector<std::uint32_t> first_; // [buckets] vertex
    std::vector<std::uint32_t> next_;  // [vertices]
};

} // namespace lodestone
