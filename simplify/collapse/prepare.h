#pragma once
// How rows of the algorithm table come to prepareEdgeCollapse().
#include "scene/scene.h"
#include "simplify/collapse/edge_collapse_source.h"

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

} // namespace lodestone
