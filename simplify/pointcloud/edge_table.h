#pragma once
// Edges of a surface looked up by their two vertices, with the faces on both sides.
#include "simplify/pointcloud/cloud_surface.h"

#include <algorithm>
#include <bit>

namespace lodestone {

struct CloudEdge {
    std::uint32_t low = kNone; // the smaller vertex
    std::uint32_t high = kNone;
    std::array<std::uint32_t, 2> faces{kNone, kNone}; // the first two
    std::uint32_t face_count = 0;                     // 0: the edge is gone

    void replace(std::uint32_t face, std::uint32_t by) {
        for (std::uint32_t& side : faces)
            if (side == face)
                side = by;
    }
};

// Open addressing, sized once; entries stay where they are.
class EdgeTable {
public:
    // Room for that many different edges.
    explicit EdgeTable(std::size_t capacity)
        : room_(capacity), slots_(std::bit_ceil(std::max<std::size_t>(16, 2 * capacity))) {}

    bool full() const { return used_ >= room_; }

    std::uint32_t slotCount() const { return static_cast<std::uint32_t>(slots_.size()); }

    CloudEdge& operator[](std::uint32_t slot) { return slots_[slot]; }

    // Slot of an edge, made where there is none (not when full).
    std::uint32_t at(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t low = std::min(a, b);
        const std::uint32_t high = std::max(a, b);
        const std::uint32_t mask = slotCount() - 1;
        std::uint64_t hash = ((std::uint64_t{low} << 32) | high) * 0x9E3779B97F4A7C15ull;
        hash ^= hash >> 32;
        for (std::uint32_t slot = static_cast<std::uint32_t>(hash) & mask;;
             slot = (slot + 1) & mask) {
            CloudEdge& edge = slots_[slot];
            if (edge.low == low && edge.high == high)
                return slot;
            if (edge.low == kNone) {
                edge.low = low;
                edge.high = high;
                ++used_;
                return slot;
            }
        }
    }

    void addFace(std::uint32_t a, std::uint32_t b, std::uint32_t face) {
        CloudEdge& edge = slots_[at(a, b)];
        if (edge.face_count < 2)
            edge.faces[edge.face_count] = face;
        ++edge.face_count;
    }

private:
    std::size_t room_;
    std::size_t used_ = 0;
    std::vector<CloudEdge> slots_;
};

} // namespace lodestone
