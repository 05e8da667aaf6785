#pragma once
#include "scene/job_context.h"
#include "scene/result.h"
#include "simplify/collapse/schedule.h"

namespace lodestone {

struct EdgeCollapseOptions {
    CollapseOptions collapse;
    FloorOptions floors;
    bool weigh_instances = true;    // IAS; false: every submesh as if it stood alone, once
    bool remove_instances = true;   // below the floors
    bool remove_by_paper = false;   // of crowds only, once nothing is left to collapse
    std::vector<std::string> notes; // of the source, for the user
};

// Sequences for every submesh of the scene, then a schedule: what all edge-collapse methods share.
// Byte gains use the default export options. Errors: Cancelled. Any thread.
Result<LodSourcePtr> prepareEdgeCollapse(ScenePtr scene,
                                         const EdgeCollapseOptions& options,
                                         const ScheduleOptions& schedule,
                                         const JobContext& job);

} // namespace lodestone
