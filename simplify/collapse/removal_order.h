#pragma once
// In which order the instances of a submesh go.
#include "scene/scene.h"

#include <span>

namespace lodestone {

// An instance of a submesh.
struct Member {
    std::uint32_t instance = 0;
    glm::dvec3 at{0.0}; // pivot in the world
    double room = 0.0;  // growth up to which its box surely stays inside the model's
    double area = 0.0;
};

constexpr double kSizeFactor = 16.0; // between areas of one size and of the next

// Whether areas of instances are so far apart that each size is thinned on its own.
constexpr bool differInSize(double least_area, double most_area) {
    return most_area > kSizeFactor * least_area;
}

// Indices into members, the first to go first. Evenly thinned at every moment: neighbours along the
// Morton curve are a stratum of two, of which one goes, in every round that halves the survivors;
// the one that would leave the model's bounds when grown goes first. Where sizes differ more than
// fourfold each size is thinned on its own, and the sizes take turns by what it costs: dwarfs go
// long before the giants among them.
// members: along a Morton curve. spots: bounds of their places. O(n log n), any thread.
std::vector<std::uint32_t> removalOrder(std::span<const Member> members, const Bounds& spots);

} // namespace lodestone
