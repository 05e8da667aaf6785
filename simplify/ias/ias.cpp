#include "simplify/ias/ias.h"

#include "simplify/bake/bake_parameters.h"
#include "simplify/collapse/prepare.h"

#include <array>
#include <cstdio>

namespace lodestone {

namespace {

constexpr std::string_view kSwitch = "ips-switch";

ParameterInfo switchParameter() {
    ParameterInfo info;
    info.id = kSwitch;
    info.label = "Few instances";
    info.tooltip =
        "Submeshes stay apart however few instances they have, and an export stores each "
        "as is smaller; or, as the paper has it, a scene with fewer than 1.75 instances "
        "per submesh is expanded and simplified as one.";
    info.kind = ParameterInfo::Kind::Choice;
    info.choices = {"never", "paper"};
    return info;
}

std::string switchNote(double instances_per_submesh) {
    std::array<char, 160> note{};
    std::snprintf(note.data(),
                  note.size(),
                  "%.2f instances per submesh, fewer than %g: expanded and simplified as one "
                  "(Quadric), as the paper has it",
                  instances_per_submesh,
                  kFewInstances);
    return note.data();
}

Result<LodSourcePtr> prepareIas(const ScenePtr& scene,
                                const ParameterValues& values,
                                const ScheduleOptions& schedule,
                                const JobContext& job) {
    Result<EdgeCollapseOptions> options = readCollapseParameters(iasAlgorithm(), values);
    if (!options)
        return tl::unexpected(options.error());
    const bool switches = parameterValue(iasAlgorithm(), values, kSwitch) > 0.5;
    const double per_submesh = instancesPerSubmesh(*scene);
    if (!switches || per_submesh >= kFewInstances)
        return prepareEdgeCollapse(scene, *options, schedule, job);
    options->notes.push_back(switchNote(per_submesh));
    return prepareExpanded(*scene, *options, schedule, job);
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
    row.parameters.push_back(switchParameter());
    addBakeParameters(row.parameters);
    row.prepare = prepareIas;
    return row;
}

} // namespace lodestone
