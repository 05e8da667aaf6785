#pragma once
// Edges of a surface, with the faces on both sides, that flips can move.
#include "simplify/pointcloud/cloud_surface.h"

#include <algorithm>

namespace lodestone {

struct CloudEdge {
    std::uint32_t low = kNone; // the smaller vertex
    std::uint32_t high = kNone;
    std::array<std::uint32_t, 2> faces{kNone, kNone}; // the first two
    std::uint32_t face_count = 0;

    void replace(std::uint32_t face, std::uint32_t by) {
        for (std::uint32_t& side : faces)
            if (side == face)
                side = by;
    }
};

// Edges are listed at the end that has fewer corners, so that no list is long. O(faces) to make.
class EdgeTable {
public:
    // Left unfinished where asked to stop.
    EdgeTable(const CloudSurface& surface, const JobContext& job)
        : corner_count_(surface.positions.size(), 0), first_(surface.positions.size(), kNone) {
        for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f)
            for (const std::uint32_t vertex : surface.corners(f))
                ++corner_count_[vertex];
        if (job.stopRequested())
            return;
        edges_.reserve(3 * surface.faces.size() / 2 + 16);
        sides_.resize(surface.faces.size());
        for (std::uint32_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
            const Triangle corners = surface.corners(f);
            for (std::size_t k = 0; k < 3; ++k)
                sides_[f][k] = addFace(corners[k], corners[(k + 1) % 3], f);
        }
    }

    std::size_t size() const { return edges_.size(); }

    CloudEdge& operator[](std::uint32_t edge) { return edges_[edge]; }

    // [3] edges of a face; side k runs from its corner k to the next.
    Triangle& sides(std::uint32_t face) { return sides_[face]; }

    bool contains(std::uint32_t a, std::uint32_t b) const { return find(a, b) != kNone; }

    // Makes an edge run between two vertices that none runs between.
    void move(std::uint32_t edge, std::uint32_t a, std::uint32_t b) {
        std::uint32_t* link = &first_[listOf(edges_[edge].low, edges_[edge].high)];
        while (*link != edge)
            link = &next_[*link];
        *link = next_[edge];
        edges_[edge].low = std::min(a, b);
        edges_[edge].high = std::max(a, b);
        std::uint32_t& first = first_[listOf(a, b)];
        next_[edge] = first;
        first = edge;
    }

private:
    std::uint32_t listOf(std::uint32_t a, std::uint32_t b) const {
        if (corner_count_[a] == corner_count_[b])
            return std::min(a, b);
        return corner_count_[a] < corner_count_[b] ? a : b;
    }

    std::uint32_t find(std::uint32_t a, std::uint32_t b) const {
        const std::uint32_t low = std::min(a, b);
        const std::uint32_t high = std::max(a, b);
        std::uint32_t edge = first_[listOf(low, high)];
        while (edge != kNone && (edges_[edge].low != low || edges_[edge].high != high))
            edge = next_[edge];
        return edge;
    }

    std::uint32_t addFace(std::uint32_t a, std::uint32_t b, std::uint32_t face) {
        std::uint32_t edge = find(a, b);
        if (edge == kNone) {
            edge = static_cast<std::uint32_t>(edges_.size());
            edges_.emplace_back();
            edges_.back().low = std::min(a, b);
            edges_.back().high = std::max(a, b);
            std::uint32_t& first = first_[listOf(a, b)];
            next_.push_back(first);
            first = edge;
        }
        CloudEdge& found = edges_[edge];
        if (found.face_count < 2)
            found.faces[found.face_count] = face;
        ++found.face_count;
        return edge;
    }

    std::vector<std::uint32_t> corner_count_; // [vertices]
    std::vector<std::uint32_t> first_;        // [vertices] edge
    std::vector<std::uint32_t> next_;         // [edges] of its list
    std::vector<CloudEdge> edges_;
    std::vector<Triangle> sides_; // [faces]
};

} // namespace lodestone
