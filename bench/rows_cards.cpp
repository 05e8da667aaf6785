#include "bench/quality.h"
#include "bench/rows.h"

#include <fmt/core.h>

namespace lodestone::bench {

namespace {

// 32,384 triangles and 8,080 instances were left there, so 68 triangles of the trunk.
Sketch cardsSketch() {
    return {0.018, 1'936, kSketchBunnySeconds, 84, "2.3", "0.27"};
}

} // namespace

Result<void> addCardRows(Bench& bench, const ScenePtr& scene) {
    const Result<ScenePtr> bunny = anchorBunny(bench.inputs);
    if (!bunny)
        return tl::unexpected(bunny.error());
    const std::vector<Contender> contenders{{[&]() -> Result<std::shared_ptr<const void>> {
                                                 return prepareIas(
                                                     scene, positionsAlone(), Ordering::Triangle);
                                             },
                                             3},
                                            {meshoptimizerWork(*bunny), 5}};
    const auto seconds = timeInTurns(contenders, bench.rounds);
    const Result<LodSourcePtr> source = prepareIas(scene, positionsAlone(), Ordering::Triangle);
    if (!seconds || !source)
        return tl::unexpected(seconds ? source.error() : seconds.error());
    Table& table = bench.table;
    const SceneCounts counts = countScene(*scene);
    addSketchTime(table, cardsSketch(), counts.unique_triangles, *seconds);
    const Result<Lod> lod = addSketchQuality(table, **source, cardsSketch(), SketchInput::Same);
    if (!lod)
        return tl::unexpected(lod.error());
    const std::uint64_t target = counts.triangles / 5;
    // A step removes one instance of four triangles; the target must be reached that closely.
    table.add({"target reached",
               countText(lod->triangles),
               "",
               fmt::format("{}–{}", countText(target - 3), countText(target)),
               "",
               lod->triangles <= target && lod->triangles + 3 >= target});
    const Result<double> area = areaLeft({scene.get(), &*lod});
    if (!area)
        return tl::unexpected(area.error());
    table.add({"area left",
               fmt::format("{:.3f}", *area),
               "sketch: 0.993",
               "0.99–1.01",
               "",
               *area >= 0.99 && *area <= 1.01});
    return {};
}

} // namespace lodestone::bench
