#include "simplify/pointcloud/vertex_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace lodestone {

VertexGrid::VertexGrid(std::span<const glm::dvec3> positions,
                       const std::vector<bool>& left_out,
                       double radius)
    : positions_(positions), radius_(radius), cell_size_(2.0 * radius),
      first_(std::bit_ceil(std::max<std::size_t>(16, positions.size())), kNone),
      next_(positions.size(), kNone) {
    for (std::size_t v = positions.size(); v-- > 0;) { // chains in rising order
        if (left_out[v])
            continue;
        std::uint32_t& first = first_[bucketOf(cellOf(positions[v]))];
        next_[v] = first;
        first = static_cast<std::uint32_t>(v);
    }
}

VertexGrid::Cell VertexGrid::cellOf(const glm::dvec3& point) const {
    return {std::floor(point.x / cell_size_),
            std::floor(point.y / cell_size_),
            std::floor(point.z / cell_size_)};
}

std::size_t VertexGrid::bucketOf(const Cell& cell) const {
    std::uint64_t hash = 0x9E3779B97F4A7C15ull;
    for (const double number : cell) {
        hash = (hash ^ std::bit_cast<std::uint64_t>(number + 0.0)) * 0xFF51AFD7ED558CCDull;
        hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash) & (first_.size() - 1);
}

void VertexGrid::takeFrom(const Cell& cell,
                          const glm::dvec3& centre,
                          std::vector<std::uint32_t>& out) {
    std::uint32_t* link = &first_[bucketOf(cell)];
    while (*link != kNone) {
        const std::uint32_t vertex = *link;
        const glm::dvec3 away = positions_[vertex] - centre;
        if (glm::dot(away, away) < radius_ * radius_ && cellOf(positions_[vertex]) == cell) {
            out.push_back(vertex);
            *link = next_[vertex];
        } else {
            link = &next_[vertex];
        }
    }
}

void VertexGrid::takeWithin(const glm::dvec3& centre, std::vector<std::uint32_t>& out) {
    const Cell low = cellOf(centre - glm::dvec3(radius_));
    const Cell high = cellOf(centre + glm::dvec3(radius_));
    for (std::size_t corner = 0; corner < 8; ++corner) {
        Cell cell = low;
        bool repeated = false;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((corner >> axis) & 1u) {
                repeated = repeated || high[axis] == low[axis];
                cell[axis] = high[axis];
            }
        if (!repeated)
            takeFrom(cell, centre, out);
    }
}

} // namespace lodestone
