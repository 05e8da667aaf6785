#include "simplify/ias/ias.h"

#include "simplify/collapse/parameters.h"

namespace lodestone {

namespace {

Result<LodSourcePtr> prepareIas(const ScenePtr& scene,
                                const ParameterValues& values,
                                const ScheduleOptions& schedule,
                                const JobContext& job) {
    const Result<EdgeCollapseOptions> options = readCollapseParameters(iasAlgorithm(), values);
    if (!options)
        return tl::unexpected(options.error());
    return prepareEdgeCollapse(scene, *options, schedule, job);
}

} // namespace

Algorithm iasAlgorithm() {
    Algorithm row;
    row.id = "ias";
    row.name = "Instance-aware (IAS)";
    row.short_name = "IAS";
    row.paper = "Azim, Cheslack-Postava and Levis 2015";
    row.summary =
        "Collapses submesh edges by the error that all instances would show; instancing and "
        "its small file stay.";
    row.parameters = collapseParameters();
    row.parameters.push_back(removalParameter());
    row.parameters.push_back(removalRuleParameter());
    row.prepare = prepareIas;
    return row;
}

} // namespace lodestone
