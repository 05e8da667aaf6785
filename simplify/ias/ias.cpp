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
        "per submesh is expanded and simplified as one; or a small scene is, if that makes "
        "its file smaller at a fifth of its triangles.";
    info.kind = ParameterInfo::Kind::Choice;
    info.choices = {"never", "paper", "size"};
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

enum class Switch : std::uint8_t { Never, Paper, Size };

// Beyond these no expanded scene was ever smaller than the instanced one at equal triangles.
constexpr double kMostInstances = 10.0;      // a submesh
constexpr std::uint64_t kMostFaces = 50'000; // instanced

bool mayBeSmallerExpanded(const Scene& scene, const ScheduleOptions& schedule) {
    const SceneCounts counts = countScene(scene);
    // What is said of single submeshes only holds while they are apart.
    return schedule.importance.empty() && schedule.locked.empty() && counts.triangles > 0 &&
           counts.triangles <= kMostFaces && instancesPerSubmesh(scene) < kMostInstances;
}

struct Weighed {
    std::uint64_t triangles = 0;
    std::uint64_t bytes = 0;
};

Weighed weighedAt(const LodSource& source, double triangles) {
    const ByteModel bytes(source.scene(), {});
    const std::uint64_t position =
        source.resolve({Target::Kind::Triangles, triangles}, bytes).position;
    return {source.trianglesAt(position), bytes.bytes(source.shapeAt(position))};
}

// Whichever weighs less where a fifth of the triangles is left; equal: the one that stays apart.
Result<LodSourcePtr> prepareSmaller(const ScenePtr& scene,
                                    const EdgeCollapseOptions& options,
                                    const ScheduleOptions& schedule,
                                    const JobContext& job) {
    constexpr double kProbe = 0.2;
    Result<LodSourcePtr> apart = prepareEdgeCollapse(scene, options, schedule, job);
    if (!apart || !mayBeSmallerExpanded(*scene, schedule))
        return apart;
    EdgeCollapseOptions expanding = options;
    expanding.notes.emplace_back("expanded and simplified as one (Quadric): at a fifth of the "
                                 "triangles the file is smaller than with instances");
    Result<LodSourcePtr> whole = prepareExpanded(*scene, std::move(expanding), schedule, job);
    if (!whole)
        return whole;
    const Weighed ours = weighedAt(**apart, kProbe * static_cast<double>((*apart)->trianglesAt(0)));
    const Weighed theirs = weighedAt(**whole, static_cast<double>(ours.triangles));
    return theirs.bytes < ours.bytes ? whole : apart;
}

Result<LodSourcePtr> prepareIas(const ScenePtr& scene,
                                const ParameterValues& values,
                                const ScheduleOptions& schedule,
                                const JobContext& job) {
    Result<EdgeCollapseOptions> options = readCollapseParameters(iasAlgorithm(), values);
    if (!options)
        return tl::unexpected(options.error());
    const auto rule = static_cast<Switch>(parameterValue(iasAlgorithm(), values, kSwitch));
    if (rule == Switch::Size)
        return prepareSmaller(scene, *options, schedule, job);
    const double per_submesh = instancesPerSubmesh(*scene);
    if (rule == Switch::Never || per_submesh >= kFewInstances)
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
    addRemovalParameters(row.parameters);
    row.parameters.push_back(switchParameter());
    addBakeParameters(row.parameters);
    row.prepare = prepareIas;
    return row;
}

} // namespace lodestone
