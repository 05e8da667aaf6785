#include "bench/meshoptimizer_peer.h"
#include "bench/quality.h"
#include "bench/rows.h"
#include "simplify/collapse/parameters.h"
#include "simplify/ias/ias.h"

#include <fmt/core.h>

namespace lodestone::bench {

namespace {

// IAS by both orderings, and how far collapses alone can take each submesh.
struct Ours {
    LodSourcePtr by_triangle;
    LodSourcePtr by_cost;
    std::vector<std::uint64_t> floors; // [submeshes] triangles
};

Result<Ours> prepareOurs(const ScenePtr& scene) {
    const ByteModel bytes(scene, ExportOptions{});
    const Result<LodSourcePtr> ias = prepareIas(scene, positionsAlone(), Ordering::Triangle);
    ParameterValues values = positionsAlone();
    values[std::string(removalParameter().id)] = 0.0;
    const Result<LodSourcePtr> no_removal = iasAlgorithm().prepare(scene, values, {}, {});
    if (!ias || !no_removal)
        return tl::unexpected((ias ? no_removal : ias).error());
    const Lod coarsest = (*no_removal)->readOut((*no_removal)->positionCount() - 1, nullptr);
    return Ours{
        *ias, (*ias)->rescheduled({Ordering::Cost, {}, {}}, bytes), trianglesBySubmesh(coarsest)};
}

void addCount(Table& table, const std::string& what, std::uint64_t count) {
    table.add({what, countText(count), "", "0", "", count == 0});
}

Result<void>
addComparison(Bench& bench, const Ours& ours, const Lod& peer, const std::string& name) {
    const Scene& scene = *ours.by_triangle->scene();
    const auto limit = static_cast<double>(peer.triangles);
    const Lod lod = lodAtTriangles(*ours.by_triangle, limit);
    const Lod cheapest = lodAtTriangles(*ours.by_cost, limit);
    const Result<Distance> peer_distance = distanceToFull({&scene, &peer});
    const Result<Distance> distance = distanceToFull({&scene, &lod});
    if (!peer_distance || !distance)
        return tl::unexpected((distance ? peer_distance : distance).error());
    Table& table = bench.table;
    table.tell(name + ": instanced triangles, instances",
               fmt::format("{}, {}", countText(lod.triangles), countText(lod.instances)),
               fmt::format("{} ({:.1f} %), {}",
                           countText(peer.triangles),
                           100.0 * limit / static_cast<double>(ours.by_triangle->trianglesAt(0)),
                           countText(peer.instances)));
    table.ratioAtMost("ordering triangle: mean distance",
                      {distance->mean / peer_distance->mean,
                       0.9,
                       percentText(distance->mean),
                       percentText(peer_distance->mean)});
    table.ratioAtMost("ordering triangle: maximum distance",
                      {distance->hausdorff / peer_distance->hausdorff,
                       1.15,
                       percentText(distance->hausdorff),
                       percentText(peer_distance->hausdorff)});
    for (const auto& [ordering, at] : {std::pair{"triangle", &lod}, {"cost", &cheapest}}) {
        const Losses losses = lossesOf(scene, *at, ours.floors);
        addCount(table,
                 fmt::format("ordering {}: submeshes vanished", ordering),
                 losses.vanished_submeshes);
        addCount(table,
                 fmt::format("ordering {}: instances lost above the floors", ordering),
                 losses.early_instances);
    }
    table.ratioAtMost("ordering cost: unique triangles",
                      {static_cast<double>(cheapest.unique_triangles) /
                           static_cast<double>(peer.unique_triangles),
                       0.25,
                       countText(cheapest.unique_triangles),
                       countText(peer.unique_triangles)});
    return {};
}

} // namespace

Result<void> addEqualRows(Bench& bench, const ScenePtr& scene) {
    const Result<Ours> ours = prepareOurs(scene);
    if (!ours)
        return tl::unexpected(ours.error());
    Result<void> added = addComparison(bench,
                                       *ours,
                                       simplifyEachMesh(*scene, 0.2, Welding::AsStored),
                                       "against " + meshoptimizerName() + ", vertices as stored");
    if (!added)
        return added;
    return addComparison(bench,
                         *ours,
                         simplifyEachMesh(*scene, 0.2, Welding::Positions),
                         "against " + meshoptimizerName() + ", positions welded");
}

} // namespace lodestone::bench
