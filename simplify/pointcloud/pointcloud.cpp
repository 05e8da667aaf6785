#include "simplify/pointcloud/pointcloud.h"

#include "simplify/pointcloud/advancing_front.h"
#include "simplify/pointcloud/point_cloud_source.h"

namespace lodestone {

namespace {

constexpr std::string_view kPercentOfDiagonal = "% of the diagonal";
constexpr std::string_view kDegrees = "\xc2\xb0";

ParameterInfo coverageParameter() {
    ParameterInfo info;
    info.id = kVertexTriplexMethod.main_id;
    info.label = "Coverage";
    info.unit = "passes";
    info.tooltip = "How often every triangle is offered to be merged; a fraction offers that part "
                   "of them. 0: as the target needs.";
    info.maximum = kVertexTriplexMethod.maximum;
    return info;
}

ParameterInfo distanceParameter() {
    ParameterInfo info;
    info.id = kIntervertexDistanceMethod.main_id;
    info.label = "Distance";
    info.unit = kPercentOfDiagonal;
    info.tooltip = "Vertices of a triangle that are nearer to each other merge. 0: as the target "
                   "needs.";
    info.maximum = 10.0;
    return info;
}

ParameterInfo radiusParameter() {
    ParameterInfo info;
    info.id = kSphericalScanningMethod.main_id;
    info.label = "Radius";
    info.unit = kPercentOfDiagonal;
    info.tooltip = "Of the sphere in which all vertices merge. 0: as the target needs.";
    info.maximum = 10.0;
    return info;
}

ParameterInfo angleParameter() {
    ParameterInfo info;
    info.id = kFaceAngleMethod.main_id;
    info.label = "Angle";
    info.unit = kDegrees;
    info.tooltip = "A vertex goes if no two faces around it meet at more than this. 0: as the "
                   "target needs.";
    info.maximum = kFaceAngleMethod.maximum;
    return info;
}

ParameterInfo firstAngleParameter() {
    ParameterInfo info = angleParameter();
    info.tooltip = "Before the sphere comes, a vertex goes if no two faces around it meet at more "
                   "than this.";
    info.fallback = 30.0;
    return info;
}

ParameterInfo passesParameter(double fallback) {
    ParameterInfo info;
    info.id = "passes";
    info.label = "Passes";
    info.tooltip = "How often all vertices are looked at; in one pass no two neighbours go.";
    info.kind = ParameterInfo::Kind::Integer;
    info.minimum = 1.0;
    info.maximum = 64.0;
    info.fallback = fallback;
    return info;
}

ParameterInfo areaParameter() {
    ParameterInfo info;
    info.id = "area";
    info.label = "Largest area";
    info.unit = "% of the surface";
    info.tooltip = "A vertex stays if the faces around it cover more than this.";
    info.maximum = 100.0;
    info.fallback = 100.0;
    return info;
}

ParameterInfo literalParameter(std::string_view tooltip) {
    ParameterInfo info;
    info.id = "literal";
    info.label = "As in the paper";
    info.tooltip = tooltip;
    info.kind = ParameterInfo::Kind::Toggle;
    return info;
}

constexpr std::string_view kLiteralCircles =
    "Circumcentres even where they lie outside their triangle, and merges that turn faces over.";
constexpr std::string_view kLiteralSpheres = "Merges that turn faces over, too.";
constexpr std::string_view kLiteralAngles =
    "What may go is decided once, on the surface as it was, not again after every pass.";

ParameterInfo retriangulationParameter() {
    ParameterInfo info;
    info.id = "retriangulation";
    info.label = "Retriangulation";
    info.tooltip = "surface: the model's own triangles, merged and flipped to Delaunay. points: "
                   "rebuilt from the points alone, slower.";
    info.kind = ParameterInfo::Kind::Choice;
    info.choices = {"surface"};
    if (canRebuildFromPoints())
        info.choices.emplace_back("points");
    return info;
}

template <Algorithm (*Row)(), const CloudMethod& Method>
Result<PointCloudOptions> optionsFrom(const ParameterValues& values) {
    const Algorithm row = Row();
    if (const Result<void> checked = checkParameters(row, values); !checked)
        return tl::unexpected(checked.error());
    PointCloudOptions options;
    options.method = &Method;
    options.main = parameterValue(row, values, Method.main_id);
    CloudSettings& settings = options.settings;
    if (parameterValue(row, values, "literal") > 0.5)
        settings.fidelity = Fidelity::Literal;
    if (parameterValue(row, values, "retriangulation") > 0.5)
        settings.retriangulation = Retriangulation::PointCloud;
    settings.angle_deg = parameterValue(row, values, "angle");
    settings.passes = static_cast<std::uint32_t>(parameterValue(row, values, "passes"));
    settings.area_share = 0.01 * parameterValue(row, values, "area");
    return options;
}

// For both ways of preparing: start(scene or another row's source, ...).
template <Algorithm (*Row)(), const CloudMethod& Method, auto Start, class From>
Result<LodSourcePtr> prepareFrom(const From& from,
                                 const ParameterValues& values,
                                 const ScheduleOptions& schedule,
                                 const JobContext& job) {
    const Result<PointCloudOptions> options = optionsFrom<Row, Method>(values);
    if (!options)
        return tl::unexpected(options.error());
    return Start(from, *options, schedule, job);
}

template <Algorithm (*Row)(), const CloudMethod& Method>
Algorithm preparedBy(Algorithm row) {
    row.prepare = prepareFrom<Row, Method, preparePointCloud, ScenePtr>;
    row.prepareLike = prepareFrom<Row, Method, preparePointCloudLike, LodSource>;
    return row;
}

// What all rows have in common.
Algorithm oneShot(std::string_view id, std::string_view name, std::string_view short_name) {
    Algorithm row;
    row.id = id;
    row.name = name;
    row.short_name = short_name;
    row.paper = "six point-cloud methods";
    row.family = Family::OneShot;
    return row;
}

} // namespace

Algorithm vertexTriplexAlgorithm() {
    Algorithm row = oneShot("vt", "Vertex triplex (VT)", "VT");
    row.summary = "Merges the vertices of one triangle after the other into the centre of its "
                  "circle.";
    row.parameters = {
        coverageParameter(), literalParameter(kLiteralCircles), retriangulationParameter()};
    return preparedBy<vertexTriplexAlgorithm, kVertexTriplexMethod>(std::move(row));
}

Algorithm faceAngleAlgorithm() {
    Algorithm row = oneShot("fad", "Face angle dependency (FAD)", "FAD");
    row.summary = "Removes vertices whose faces lie nearly in one plane and closes the holes.";
    row.parameters = {angleParameter(),
                      passesParameter(8.0),
                      areaParameter(),
                      literalParameter(kLiteralAngles),
                      retriangulationParameter()};
    return preparedBy<faceAngleAlgorithm, kFaceAngleMethod>(std::move(row));
}

Algorithm intervertexDistanceAlgorithm() {
    Algorithm row = oneShot("ivdd", "Intervertex distance dependence (IVDD)", "IVDD");
    row.summary = "Merges the vertices of a triangle that are near to each other.";
    row.parameters = {
        distanceParameter(), literalParameter(kLiteralCircles), retriangulationParameter()};
    return preparedBy<intervertexDistanceAlgorithm, kIntervertexDistanceMethod>(std::move(row));
}

Algorithm sphericalScanningAlgorithm() {
    Algorithm row = oneShot("ss", "Spherical scanning (SS)", "SS");
    row.summary = "Moves a sphere over the vertices; all inside become one.";
    row.parameters = {
        radiusParameter(), literalParameter(kLiteralSpheres), retriangulationParameter()};
    return preparedBy<sphericalScanningAlgorithm, kSphericalScanningMethod>(std::move(row));
}

Algorithm vertexTriplexDistanceAlgorithm() {
    Algorithm row = oneShot("vtd", "Vertex triplex distance (VTD)", "VTD");
    row.summary = "Small triangles become the centre of their circle; beside a short edge the "
                  "longer one becomes its midpoint.";
    row.parameters = {
        distanceParameter(), literalParameter(kLiteralCircles), retriangulationParameter()};
    return preparedBy<vertexTriplexDistanceAlgorithm, kVertexTriplexDistanceMethod>(std::move(row));
}

Algorithm faceAngleScanningAlgorithm() {
    Algorithm row = oneShot("fass", "Face angle spherical scanning (FASS)", "FASS");
    row.summary = "FAD, then SS on what remains.";
    row.parameters = {radiusParameter(),
                      firstAngleParameter(),
                      passesParameter(1.0),
                      areaParameter(),
                      literalParameter(kLiteralSpheres),
                      retriangulationParameter()};
    return preparedBy<faceAngleScanningAlgorithm, kFaceAngleScanningMethod>(std::move(row));
}

} // namespace lodestone
