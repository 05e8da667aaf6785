#pragma once
// One-shot methods behind the contract of a source. A position is a rung of a ladder of values of
// the method's main parameter; a LOD is computed when it is asked for and the last ones are kept.
// Targets are searched for along the rungs: the counts of a rung need neither the last flips nor
// the geometry, which follow once for the rung that was found.
#include "scene/result.h"
#include "simplify/lod_source.h"
#include "simplify/pointcloud/cloud_method.h"

namespace lodestone {

struct PointCloudOptions {
    const CloudMethod* method = nullptr;
    // > 0: this value of the main parameter, whatever the target; 0: as the target needs.
    double main = 0.0;
    CloudSettings settings; // main is overwritten
};

// Welds every submesh and tries the method where searches for a target begin, or at the given
// value. Distances are divided by the largest scale of the submesh's instances. A submesh keeps at
// least min(4, its own) triangles. One of several instances also keeps two fifths of its extents,
// or what is thin would sink into what it lies on: until every submesh is as coarse as that allows,
// and not where the method is to be literal. Errors: Cancelled. Any thread, deterministic.
Result<LodSourcePtr> preparePointCloud(ScenePtr scene,
                                       const PointCloudOptions& options,
                                       const ScheduleOptions& schedule,
                                       const JobContext& job);

// The same for the scene of another source; what is welded is taken from it if it is one of these.
Result<LodSourcePtr> preparePointCloudLike(const LodSource& other,
                                           const PointCloudOptions& options,
                                           const ScheduleOptions& schedule,
                                           const JobContext& job);

} // namespace lodestone
