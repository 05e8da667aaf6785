#pragma once
// How rows of the algorithm table come to prepareEdgeCollapse().
#include "scene/scene.h"
#include "simplify/collapse/parameters.h"

namespace lodestone {

// A scene and how its collapses are put in order.
struct CollapseInput {
    ScenePtr scene;
    ScheduleOptions schedule;
};

// The de-instanced scene and what of the schedule still holds for it: importance and locks speak of
// the input's submeshes, which are no longer there. Errors: Cancelled. Any thread.
Result<CollapseInput>
expandInput(const Scene& scene, const ScheduleOptions& schedule, const JobContext& job);

// Whether a scene has so few instances a submesh that the IAS paper expands it.
bool hasFewInstances(const Scene& scene);

enum class Weighing : std::uint8_t {
    ByInstances, // an error counts as often and as large as it is seen
    Alone,       // every submesh as if it stood there once
};

// Algorithm::prepare of rows that collapse the scene's own submeshes.
template <Algorithm (*row)(), Weighing weighing>
Result<LodSourcePtr> prepareSubmeshes(const ScenePtr& scene,
                                      const ParameterValues& values,
                                      const ScheduleOptions& schedule,
                                      const JobContext& job) {
    Result<EdgeCollapseOptions> options = readCollapseParameters(row(), values);
    if (!options)
        return tl::unexpected(options.error());
    options->weigh_instances = weighing == Weighing::ByInstances;
    return prepareEdgeCollapse(scene, *options, schedule, job);
}

} // namespace lodestone
