#pragma once
// Removing instances of a submesh that can be collapsed no further (stochastic simplification:
// Cook, Halstead, Planck, Ryu 2007), nested and stratified.
#include "scene/scene.h"

namespace lodestone {

struct RemovalSequence {
    // All instances of the submesh, the longest-lived first: n kept instances are the first n.
    std::shared_ptr<const std::vector<std::uint32_t>> order; // indices into Scene::instances
    // cost[i]: of removing the (i + 1)-th instance to go, world length^4: its area times the
    // squared distance to the nearest instance that outlives it, as a running maximum.
    std::vector<double> cost; // [instances - 1]
    std::vector<float> error; // [instances - 1] that distance, world units
    // area_left[k]: world area of the first k of order, so that survivors can be grown to keep it.
    std::vector<double> area_left; // [instances + 1]
    glm::dvec3 pivot{0.0};         // of the growing, in the submesh's space

    bool possible() const { return !cost.empty(); }
};

// Survivors are enlarged by at most this factor; beyond it the area falls.
constexpr double kMaxGrowth = 4.0;

// Growth of the survivors' size when `kept` of all instances are left: sqrt(area of all / kept).
double growthAt(const RemovalSequence& removal, std::uint32_t kept);

// Plans the removals of a submesh's instances. scene_bounds: those of the original model; instances
// that would leave it when grown go first within their stratum. O(n log n), any thread.
RemovalSequence planRemoval(const Scene& scene,
                            std::uint32_t submesh,
                            InstanceRange range,
                            const Bounds& scene_bounds);

} // namespace lodestone
