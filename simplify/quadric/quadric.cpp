#include "simplify/quadric/quadric.h"

#include "simplify/bake/bake_parameters.h"
#include "simplify/collapse/prepare.h"

namespace lodestone {

namespace {

Result<LodSourcePtr> prepareQuadric(const ScenePtr& scene,
                                    const ParameterValues& values,
                                    const ScheduleOptions& schedule,
                                    const JobContext& job) {
    const Result<EdgeCollapseOptions> options = readCollapseParameters(quadricAlgorithm(), values);
    if (!options)
        return tl::unexpected(options.error());
    return prepareExpanded(*scene, *options, schedule, job);
}

Result<LodSourcePtr> prepareQuadricSubmesh(const ScenePtr& scene,
                                           const ParameterValues& values,
                                           const ScheduleOptions& schedule,
                                           const JobContext& job) {
    Result<EdgeCollapseOptions> options = readCollapseParameters(quadricSubmeshAlgorithm(), values);
    if (!options)
        return tl::unexpected(options.error());
    options->weigh_instances = false;
    return prepareEdgeCollapse(scene, *options, schedule, job);
}

} // namespace

Algorithm quadricAlgorithm() {
    Algorithm row;
    row.id = "quadric";
    row.name = "Quadric (expanded)";
    row.short_name = "Quadric";
    row.paper = "Garland and Heckbert 1997";
    row.summary = "Collapses the edges of the de-instanced scene, as instancing-blind tools do.";
    row.expands = true;
    row.parameters = collapseParameters();
    addBakeParameters(row.parameters);
    row.prepare = prepareQuadric;
    return row;
}

Algorithm quadricSubmeshAlgorithm() {
    Algorithm row;
    row.id = "quadric-submesh";
    row.name = "Quadric per submesh";
    row.short_name = "Quadric/submesh";
    row.paper = "Garland and Heckbert 1997";
    row.summary =
        "Collapses each submesh as if it stood alone; ignores how often and how large its "
        "instances are.";
    row.parameters = collapseParameters();
    addRemovalParameters(row.parameters);
    addBakeParameters(row.parameters);
    row.prepare = prepareQuadricSubmesh;
    return row;
}

} // namespace lodestone
