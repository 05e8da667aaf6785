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

// Collapses the de-instanced scene as one. Errors: Cancelled. Any thread.
Result<LodSourcePtr> prepareExpanded(const Scene& scene,
                                     EdgeCollapseOptions options,
                                     const ScheduleOptions& schedule,
                                     const JobContext& job);

// 0 for a scene without submeshes.
double instancesPerSubmesh(const Scene& scene);

// Below so many instances a submesh the paper expands a scene (Azim et al. 2015).
inline constexpr double kFewInstances = 1.75;

} // namespace lodestone
