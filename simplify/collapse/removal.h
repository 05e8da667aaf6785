#pragma once
// Removing instances of a submesh that can be collapsed no further (stochastic simplification:
// Cook, Halstead, Planck, Ryu 2007), nested and stratified.
#include "simplify/collapse/removal_cover.h"

namespace lodestone {

struct RemovalSequence {
    // All instances of the submesh, the longest-lived first: n kept instances are the first n.
    std::shared_ptr<const std::vector<std::uint32_t>> order; // indices into Scene::instances
    // cost[i]: of removing the (i + 1)-th instance to go, world length^4: its area times the
    // squared distance to the nearest of its sisters that outlives it, as a running maximum; where
    // sizes are unlike as rising means, lest a dwarf far off price the giants. With a
    // cover that is nearer than the sisters, that distance x (cover / sisters' mean at the start),
    // no less than / sqrt(instances).
    std::vector<double> cost; // [instances - 1]
    std::vector<float> error; // [instances - 1] that distance, world units
    // area_left[k]: world area of the first k of order, so that survivors can be grown to keep it.
    std::vector<double> area_left; // [instances + 1]
    std::vector<float> growth;     // [instances - 1] of the survivors' size after each removal
    glm::dvec3 pivot{0.0};         // of the growing, in the submesh's space

    bool possible() const { return !cost.empty(); }
};

// Survivors are enlarged by at most this factor; beyond it (fewer than one in 25 left) the area
// falls.
constexpr double kMaxGrowth = 5.0;
// Nor does growing move their surface by more than this share of the model's diagonal: a twig five
// times as long would stick out of the crown. Less brings distances down a little more, and makes
// crowns thin.
constexpr double kGrowthReach = 0.03;

// Growth of the survivors' size when `kept` of all instances are left: sqrt(area of all / kept).
// No more than kMaxGrowth, nor than moves a surface of mean size by kGrowthReach of the diagonal.
// Where a cover is nearer than the sisters it is bounded by 1 + cover / radius: a window must not
// outgrow its wall to make up for others. Of unlike sizes each removal may make the largest that is
// left swell by no more than the distance from what goes to the nearest of what is left; growth
// never falls, so that a wider gap before may have let it swell more.
double growthAt(const RemovalSequence& removal, std::uint32_t kept);

// Whether the paper's rule thins out a submesh: it has a twentieth of all instances, or 1,000.
bool isCrowd(std::uint32_t instances, std::size_t instances_in_all);

// Makes removals dearer than any collapse, as the paper has it: they begin when nothing is left to
// collapse. Among themselves their order stays.
void putOff(RemovalSequence& removal);

// Plans the removals of a submesh's instances. facts: the submesh's. scene_bounds: those of the
// original model; instances that would leave it when grown go first within their stratum. O(n log
// n), any thread.
RemovalSequence planRemoval(const Scene& scene,
                            InstanceRange range,
                            const SubmeshFacts& facts,
                            const Bounds& scene_bounds,
                            const Cover& cover);

} // namespace lodestone
