#include "simplify/pointcloud/cloud_ladder.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr double kDistanceDecades = 5.0; // from the lowest rung to the highest

// Geometric mean over the triangles that are drawn, so that many small ones count as they should.
double typicalEdge(const CloudScene& scene) {
    double logarithms = 0.0;
    double triangles = 0.0;
    for (const CloudSubmesh& submesh : scene.submeshes) {
        const double edge = submesh.edge_length * submesh.stretch / scene.diagonal;
        if (!(edge > 0.0))
            continue;
        const double drawn = static_cast<double>(submesh.triangles) * submesh.instances;
        logarithms += drawn * std::log(edge);
        triangles += drawn;
    }
    return triangles > 0.0 ? 100.0 * std::exp(logarithms / triangles) : 0.0;
}

} // namespace

CloudScenePtr makeCloudScene(ScenePtr scene, const JobContext& job) {
    auto made = std::make_shared<CloudScene>();
    const Bounds bounds = robustWorldBounds(*scene);
    made->diagonal = bounds.diagonal() > 0.0 ? bounds.diagonal() : 1.0;
    const std::vector<InstanceRange> ranges = instanceRanges(*scene);
    made->submeshes.resize(scene->submeshes.size());
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t s) {
        const std::span<const Instance> instances(scene->instances);
        made->submeshes[s] = makeCloudSubmesh(
            scene->submeshes[s], instances.subspan(ranges[s].begin, ranges[s].size()), job);
    });
    made->scene = std::move(scene);
    made->edge_length = typicalEdge(*made);
    return made;
}

double CloudLadder::valueOf(std::uint64_t rung) const {
    const double along = static_cast<double>(std::min(rung, kRungs)) / static_cast<double>(kRungs);
    switch (method_->main) {
    case MainParameter::Coverage:
        return method_->maximum * along;
    case MainParameter::AngleDeg: // surfaces are mostly flat: fine steps there
        return method_->maximum * along * along;
    case MainParameter::DistancePct:
        break;
    }
    return method_->maximum * std::pow(10.0, kDistanceDecades * (along - 1.0));
}

std::uint64_t CloudLadder::rungOf(double value) const {
    std::uint64_t low = 0;
    std::uint64_t high = kRungs;
    while (low < high) {
        const std::uint64_t middle = low + (high - low) / 2;
        if (valueOf(middle) < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

CloudSettings CloudLadder::settingsOf(std::uint64_t rung, const CloudSettings& base) const {
    CloudSettings settings = base;
    settings.main = valueOf(rung);
    if (rung > kRungs)
        settings.passes += static_cast<std::uint32_t>(rung - kRungs);
    return settings;
}

std::vector<std::uint64_t> CloudLadder::usualRungs(const CloudScene& scene) const {
    const double unit = method_->main == MainParameter::DistancePct ? scene.edge_length : 1.0;
    std::vector<std::uint64_t> rungs;
    for (const double value : method_->usual)
        rungs.push_back(std::clamp<std::uint64_t>(rungOf(value * unit), 1, kRungs));
    return rungs;
}

} // namespace lodestone
