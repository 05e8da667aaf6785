#include "bench/meshoptimizer_peer.h"
#include "bench/quality.h"
#include "bench/rows.h"
#include "simplify/collapse/parameters.h"
#include "simplify/ias/ias.h"
#include "simplify/quadric/quadric.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace lodestone::bench {

ParameterValues positionsAlone() {
    return {
        {"uv-weight", 0.0}, {"normal-weight", 0.0}, {"color-weight", 0.0}, {"motion-weight", 0.0}};
}

Result<LodSourcePtr> prepareQuadric(const ScenePtr& expanded, const ParameterValues& values) {
    Result<EdgeCollapseOptions> options = readCollapseParameters(quadricAlgorithm(), values);
    if (!options)
        return tl::unexpected(options.error());
    options->remove_instances = false; // as its row does
    return prepareEdgeCollapse(expanded, *options, {}, {});
}

Result<LodSourcePtr>
prepareIas(const ScenePtr& scene, const ParameterValues& values, Ordering ordering) {
    return iasAlgorithm().prepare(scene, values, {ordering, {}, {}}, {});
}

Result<ScenePtr> anchorBunny(Inputs& inputs) {
    Result<ScenePtr> stanford = inputs.stanfordBunny();
    return stanford && !*stanford ? inputs.own("bunny") : stanford;
}

Work meshoptimizerWork(const ScenePtr& scene) {
    auto welded = std::make_shared<const Geometry>(
        weldPositions(*scene->submeshes.front().primitives.front().geometry));
    return [welded]() -> Result<std::shared_ptr<const void>> {
        return std::make_shared<const std::vector<std::uint32_t>>(
            meshoptimizerSimplify(*welded, 0.2));
    };
}

void addSketchTime(Table& table,
                   const Sketch& sketch,
                   std::uint64_t triangles,
                   std::span<const std::vector<double>> seconds_and_anchor) {
    const double ratio = medianRatio(seconds_and_anchor[0], seconds_and_anchor[1]) /
                         static_cast<double>(triangles) /
                         (sketch.seconds / sketch.anchor_seconds / sketch.triangles);
    const Spread seconds = spreadOf(seconds_and_anchor[0]);
    table.ratioAtMost("whole sequence, over meshoptimizer's time and per unique triangle",
                      {ratio,
                       1.0,
                       fmt::format("{}, {:.3f} µs a triangle",
                                   secondsText(seconds),
                                   1e6 * seconds.median / static_cast<double>(triangles)),
                       fmt::format("sketch: {}, {:.3f} µs a triangle",
                                   secondsText(sketch.seconds),
                                   1e6 * sketch.seconds / sketch.triangles)});
}

void addAttributeTime(Table& table,
                      const std::vector<double>& by_default,
                      const std::vector<double>& positions_alone) {
    table.ratioAtMost("attributes counted, as by default: over positions alone",
                      {medianRatio(by_default, positions_alone),
                       2.5,
                       secondsText(spreadOf(by_default)),
                       secondsText(spreadOf(positions_alone))});
}

namespace {

struct SketchError {
    const char* name;
    double value;        // ours
    std::string printed; // the sketch's
};

// Met if the value, rounded as the sketch's was printed, is no larger.
void addSketchError(Table& table, const SketchError& error, SketchInput input) {
    const std::string what = std::string("at 20 %: ") + error.name;
    if (input == SketchInput::Another) {
        table.tell(what, percentText(error.value), "sketch's scene: " + error.printed + " %");
        return;
    }
    const auto decimals = static_cast<int>(error.printed.size() - error.printed.find('.') - 1);
    const double rounding = 0.5 * std::pow(10.0, -decimals);
    table.atMost(what,
                 {error.value,
                  std::stod(error.printed) + rounding,
                  percentText(error.value),
                  error.printed + " %",
                  "sketch"});
}

} // namespace

Result<Lod>
addSketchQuality(Table& table, const LodSource& source, const Sketch& sketch, SketchInput input) {
    const double full = static_cast<double>(source.trianglesAt(0));
    Lod lod = lodAtTriangles(source, 0.2 * full);
    const Result<Distance> distance = distanceToFull({source.scene().get(), &lod});
    if (!distance)
        return tl::unexpected(distance.error());
    table.tell("at 20 %: unique triangles, instances left",
               fmt::format("{}, {} of {}",
                           countText(lod.unique_triangles),
                           countText(lod.instances),
                           countText(source.scene()->instances.size())),
               fmt::format("sketch: {}", countText(sketch.unique_left)));
    const Result<double> at_vertices = farthestVertex({source.scene().get(), &lod});
    if (!at_vertices)
        return tl::unexpected(at_vertices.error());
    table.tell("at 20 %: maximum distance", percentText(distance->hausdorff));
    // The sketch's was found at samples and vertices.
    addSketchError(table,
                   {"maximum distance at samples and vertices",
                    std::max(distance->sampled_max, *at_vertices),
                    sketch.hausdorff},
                   input);
    addSketchError(table, {"mean distance", distance->mean, sketch.mean}, input);
    return lod;
}

} // namespace lodestone::bench
