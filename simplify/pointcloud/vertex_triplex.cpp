#include "simplify/pointcloud/circles.h"
#include "simplify/pointcloud/merge_builder.h"
#include "simplify/pointcloud/methods.h"

namespace lodestone {

namespace {

// 0..1, evenly spread however far one counts (Weyl sequence of the golden ratio).
double spreadOf(std::uint32_t number) {
    return static_cast<double>(number * 2654435769u) / 4294967296.0;
}

} // namespace

Merges
vertexTriplex(const CloudSurface& surface, double share, Fidelity fidelity, const JobContext& job) {
    MergeBuilder builder(surface, fidelity, job);
    std::vector<bool> merged(surface.positions.size(), false);
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
        if (stopsAt(f, job))
            break;
        const Triangle corners = surface.corners(f);
        if (spreadOf(f) >= share || merged[corners[0]] || merged[corners[1]] || merged[corners[2]])
            continue;
        if (!builder.merge(corners, triplexCentre(surface.points(f), fidelity)))
            continue;
        for (const std::uint32_t vertex : corners)
            merged[vertex] = true;
    }
    return builder.finish();
}

} // namespace lodestone
