#pragma once
// What is left to look at where an instance goes: grass lies on the ground, a window on its wall.
#include "simplify/collapse/removal_facts.h"
#include "simplify/collapse/sequence.h"

namespace lodestone {

struct Cover {
    // Root of the mean squared distance of a submesh's surface from the nearest surface of clearly
    // larger instances, world units; infinite beyond half the submesh's radius.
    double distance = std::numeric_limits<double>::infinity();
    // The same with what a change of colour counts: half the submesh's radius for black on white.
    double cost_distance = std::numeric_limits<double>::infinity();
};

// Covers of the submeshes with several instances, [submeshes]. Rough: sampled at a few instances;
// a larger instance is one of a submesh whose mean instance has at least four times the area, as
// far as 100,000 triangles go, the largest first, off by up to `tolerance` (world) or a tenth of
// the smallest submesh's radius. facts, sequences [submeshes]. Deterministic. Any thread.
// O(wedges + instances).
std::vector<Cover> findCovers(const Scene& scene,
                              std::span<const InstanceRange> ranges,
                              std::span<const SubmeshFacts> facts,
                              std::span<const CollapseSequence> sequences,
                              double tolerance);

} // namespace lodestone
