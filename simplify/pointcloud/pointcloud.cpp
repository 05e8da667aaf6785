#include "simplify/pointcloud/pointcloud.h"

#include "simplify/pointcloud/point_cloud_source.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::string_view kPaper = "six point-cloud methods";

ParameterInfo coverageParameter() {
    ParameterInfo info;
    info.id = "coverage";
    info.label = "Coverage";
    info.unit = "passes";
    info.tooltip = "How often every triangle is offered to be merged; a fraction offers that part "
                   "of them. 0: as the target needs.";
    info.maximum = kVertexTriplexMethod.maximum;
    return info;
}

ParameterInfo literalParameter() {
    ParameterInfo info;
    info.id = "literal";
    info.label = "As in the paper";
    info.tooltip = "Circumcentres that may lie outside their triangle, and no check that a merge "
                   "turns a face over.";
    info.kind = ParameterInfo::Kind::Toggle;
    return info;
}

Result<PointCloudOptions>
readOptions(const Algorithm& row, const CloudMethod& method, const ParameterValues& values) {
    for (const auto& [id, value] : values) {
        const auto found =
            std::ranges::find(row.parameters, std::string_view(id), &ParameterInfo::id);
        if (found == row.parameters.end())
            return fail(ErrorKind::Usage, std::string(row.id) + ": unknown parameter '" + id + "'");
        const double maximum = found->kind == ParameterInfo::Kind::Choice
                                   ? static_cast<double>(found->choices.size() - 1)
                                   : found->maximum;
        if (!(value >= found->minimum && value <= maximum))
            return fail(ErrorKind::Usage,
                        std::string(row.id) + ": parameter '" + id + "' is out of range");
    }
    PointCloudOptions options;
    options.method = &method;
    options.main = parameterValue(row, values, method.main_id);
    if (parameterValue(row, values, "literal") > 0.5)
        options.settings.fidelity = Fidelity::Literal;
    return options;
}

template <Algorithm (*Row)(), const CloudMethod& Method>
Result<LodSourcePtr> prepare(const ScenePtr& scene,
                             const ParameterValues& values,
                             const ScheduleOptions& schedule,
                             const JobContext& job) {
    const Result<PointCloudOptions> options = readOptions(Row(), Method, values);
    if (!options)
        return tl::unexpected(options.error());
    return preparePointCloud(scene, *options, schedule, job);
}

Algorithm commonRow() {
    Algorithm row;
    row.paper = kPaper;
    row.family = Family::OneShot;
    return row;
}

} // namespace

Algorithm vertexTriplexAlgorithm() {
    Algorithm row = commonRow();
    row.id = "vt";
    row.name = "Vertex triplex (VT)";
    row.short_name = "VT";
    row.summary = "Merges the three vertices of triangle after triangle into the centre of its "
                  "circle.";
    row.parameters = {coverageParameter(), literalParameter()};
    row.prepare = prepare<vertexTriplexAlgorithm, kVertexTriplexMethod>;
    return row;
}

} // namespace lodestone
