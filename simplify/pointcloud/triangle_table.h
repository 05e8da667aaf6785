#pragma once
// Faces looked up by the three vertices that they stand on, in either orientation.
#include "simplify/pointcloud/cloud_surface.h"

#include <algorithm>
#include <bit>

namespace lodestone {

struct TriangleKey {
    Triangle vertices{kNone, kNone, kNone}; // rising
    std::uint32_t group = 0;                // faces of different groups never meet
    bool turned = false;                    // an odd permutation of `vertices`
};

inline TriangleKey triangleKey(Triangle corners, std::uint32_t group) {
    TriangleKey key{corners, group, false};
    const auto order = [&](std::size_t a, std::size_t b) {
        if (key.vertices[a] > key.vertices[b]) {
            std::swap(key.vertices[a], key.vertices[b]);
            key.turned = !key.turned;
        }
    };
    order(0, 1);
    order(1, 2);
    order(0, 1);
    return key;
}

// Open addressing, sized once for a number of faces.
class TriangleTable {
public:
    struct Entry {
        Triangle vertices{kNone, kNone, kNone};
        std::uint32_t group = 0;
        // For the user: first face of each orientation, and how many there are.
        std::uint32_t forward = kNone;
        std::uint32_t backward = kNone;
        std::uint32_t forward_count = 0;
        std::uint32_t backward_count = 0;
        bool forward_pinned = false; // one of them stays whatever cancels
        bool backward_pinned = false;
        bool forward_upright = false; // one of them has not been turned over
        bool backward_upright = false;
    };

    // Not to be used where asked to stop.
    TriangleTable(std::size_t faces, const JobContext& job) {
        constexpr std::size_t kAtOnce = 32'768;
        const std::size_t slots = std::bit_ceil(std::max<std::size_t>(16, 2 * faces));
        slots_.reserve(slots);
        while (slots_.size() < slots && !job.stopRequested())
            slots_.resize(std::min(slots, slots_.size() + kAtOnce));
    }

    // The entry of a key, made where there is none.
    Entry& at(const TriangleKey& key) {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t slot = hash(key) & mask;; slot = (slot + 1) & mask) {
            Entry& entry = slots_[slot];
            if (entry.vertices[0] == kNone) {
                entry.vertices = key.vertices;
                entry.group = key.group;
                return entry;
            }
            if (entry.vertices == key.vertices && entry.group == key.group)
                return entry;
        }
    }

private:
    static std::size_t hash(const TriangleKey& key) {
        std::uint64_t value = key.group;
        for (const std::uint32_t vertex : key.vertices)
            value = (value ^ vertex) * 0x9E3779B97F4A7C15ull;
        return static_cast<std::size_t>(value ^ (value >> 29));
    }

    std::vector<Entry> slots_;
};

} // namespace lodestone
