#include "bench/meshoptimizer_peer.h"
#include "bench/quality.h"
#include "bench/rows.h"

#include <fmt/core.h>

namespace lodestone::bench {

AloneTargets bunnyTargets() {
    return {3.0, 0.72, 1.0, {0.093, 69'451, kSketchBunnySeconds, 13'889, "0.116", "0.0107"}};
}

AloneTargets sphereTargets() {
    return {2.5,
            0.66,
            std::nullopt,
            {1.37, 1'002'252, kSketchSphereSeconds, 200'450, "0.045", "0.0046"}};
}

namespace {

constexpr std::uint64_t kShortBelow = 200'000; // triangles: timed more often

// Distances of ours and the peer's at the peer's number of triangles.
Result<void> addDistances(Bench& bench, const LodSource& source, const AloneTargets& targets) {
    const Scene& scene = *source.scene();
    const Geometry welded = weldPositions(*scene.submeshes.front().primitives.front().geometry);
    const Lod peer_lod = lodOfIndices(scene, welded, meshoptimizerSimplify(welded, 0.2));
    const Lod lod = lodAtTriangles(source, static_cast<double>(peer_lod.triangles));
    const Result<Distance> ours = distanceToFull({&scene, &lod});
    const Result<Distance> peer = distanceToFull({&scene, &peer_lod});
    if (!ours || !peer)
        return tl::unexpected((ours ? peer : ours).error());
    const std::string at = fmt::format(
        " at {} triangles (peer: {})", countText(lod.triangles), countText(peer_lod.triangles));
    bench.table.ratioAtMost("mean distance" + at,
                            {ours->mean / peer->mean,
                             targets.mean_ratio,
                             percentText(ours->mean),
                             percentText(peer->mean)});
    const double maxima = ours->hausdorff / peer->hausdorff;
    if (targets.maximum_ratio)
        bench.table.ratioAtMost("maximum distance",
                                {maxima,
                                 *targets.maximum_ratio,
                                 percentText(ours->hausdorff),
                                 percentText(peer->hausdorff)});
    else
        bench.table.tell(
            "maximum distance", percentText(ours->hausdorff), percentText(peer->hausdorff));
    return {};
}

} // namespace

Result<void>
addAloneRows(Bench& bench, const ScenePtr& scene, const AloneTargets& targets, SketchInput input) {
    const int runs = countScene(*scene).triangles < kShortBelow ? 5 : 1;
    using Made = Result<std::shared_ptr<const void>>;
    const std::vector<Contender> contenders{
        {[&]() -> Made { return prepareQuadric(scene, positionsAlone()); }, runs},
        {meshoptimizerWork(scene), runs},
        {[&]() -> Made { return prepareQuadric(scene, {}); }, runs}};
    const auto seconds = timeInTurns(contenders, bench.rounds);
    if (!seconds)
        return tl::unexpected(seconds.error());
    const Result<LodSourcePtr> source = prepareQuadric(scene, positionsAlone());
    if (!source)
        return tl::unexpected(source.error());
    const std::uint64_t triangles = (*source)->trianglesAt(0);
    bench.table.ratioAtMost(
        fmt::format("Quadric, positions alone, {} triangles, whole sequence", countText(triangles)),
        {medianRatio((*seconds)[0], (*seconds)[1]),
         targets.time_ratio,
         secondsText(spreadOf((*seconds)[0])),
         meshoptimizerName() + " to 20 %: " + secondsText(spreadOf((*seconds)[1]))});
    Result<void> distances = addDistances(bench, **source, targets);
    if (!distances)
        return distances;
    addSketchTime(bench.table, targets.sketch, triangles, *seconds);
    const Result<Lod> lod = addSketchQuality(bench.table, **source, targets.sketch, input);
    if (!lod)
        return tl::unexpected(lod.error());
    addAttributeTime(bench.table, (*seconds)[2], (*seconds)[0]);
    return {};
}

} // namespace lodestone::bench
