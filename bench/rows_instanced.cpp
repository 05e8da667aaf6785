#include "bench/rows.h"
#include "scene/expand.h"
#include "simplify/quadric/quadric.h"

#include <fmt/core.h>

namespace lodestone::bench {

InstancedTargets mapleTargets() {
    constexpr double kUnique = 85'046;
    return {15.0,
            {0.10, kUnique, kSketchBunnySeconds, 8'499, "0.073", "0.0057"},
            {0.10, kUnique, kSketchBunnySeconds, 1'520, "0.307", "0.0078"},
            Sketch{3.2, 1'818'074, kSketchSphereSeconds, 363'614, "0.069", "0.0048"}};
}

InstancedTargets villageTargets() {
    constexpr double kUnique = 96'028;
    return {8.0,
            {0.135, kUnique, kSketchBunnySeconds, 43'722, "0.111", "0.0011"},
            {0.135, kUnique, kSketchBunnySeconds, 10'750, "0.071", "0.0021"},
            std::nullopt};
}

namespace {

// CPU seconds [rounds] of what is timed in turns.
struct Times {
    std::vector<double> by_triangle; // positions alone, as all below
    std::vector<double> by_cost;
    std::vector<double> unweighted; // every submesh as if it stood alone
    std::vector<double> expanded;
    std::vector<double> bunny_anchor;
    std::vector<double> sphere_anchor;
    std::vector<double> by_default; // attributes count
};

Result<Times> timeAll(Bench& bench, const ScenePtr& scene, const ScenePtr& expanded) {
    const Result<ScenePtr> bunny = anchorBunny(bench.inputs);
    const Result<ScenePtr> sphere = bench.inputs.own("sphere");
    if (!bunny || !sphere)
        return tl::unexpected((bunny ? sphere : bunny).error());
    using Made = Result<std::shared_ptr<const void>>;
    const ParameterValues values = positionsAlone();
    const Algorithm alone = quadricSubmeshAlgorithm();
    const std::vector<Contender> contenders{
        {[&]() -> Made { return prepareIas(scene, values, Ordering::Triangle); }, 3},
        {[&]() -> Made { return prepareIas(scene, values, Ordering::Cost); }, 3},
        {meshoptimizerWork(*bunny), 5},
        {[&]() -> Made { return alone.prepare(scene, values, {}, {}); }, 3},
        {[&]() -> Made { return prepareQuadric(expanded, values); }, 1},
        {meshoptimizerWork(*sphere), 1},
        {[&]() -> Made { return prepareIas(scene, {}, Ordering::Triangle); }, 3}};
    Result<std::vector<std::vector<double>>> seconds = timeInTurns(contenders, bench.rounds);
    if (!seconds)
        return tl::unexpected(seconds.error());
    std::vector<std::vector<double>>& all = *seconds;
    return Times{all[0], all[1], all[3], all[4], all[2], all[5], all[6]};
}

void addSpeed(Bench& bench, const SceneCounts& counts, const Times& times, double speedup) {
    const Spread ias = spreadOf(times.by_triangle);
    const Spread quadric = spreadOf(times.expanded);
    const auto unique = static_cast<double>(counts.unique_triangles);
    const auto instanced = static_cast<double>(counts.triangles);
    bench.table.ratioAtLeast(
        fmt::format("IAS, positions alone, {} unique triangles: sequences and schedule",
                    countText(counts.unique_triangles)),
        {medianRatio(times.expanded, times.by_triangle),
         speedup,
         secondsText(ias),
         fmt::format(
             "Quadric, {} expanded: {}", countText(counts.triangles), secondsText(quadric))});
    bench.table.ratioAtMost("time per unique triangle",
                            {medianRatio(times.by_triangle, times.expanded) * instanced / unique,
                             1.3,
                             fmt::format("{:.3f} µs", 1e6 * ias.median / unique),
                             fmt::format("Quadric: {:.3f} µs", 1e6 * quadric.median / instanced)});
    bench.table.ratioAtMost("what instances cost: over Quadric on each submesh drawn once",
                            {medianRatio(times.by_triangle, times.unweighted),
                             1.3,
                             secondsText(ias),
                             secondsText(spreadOf(times.unweighted))});
    addAttributeTime(bench.table, times.by_default, times.by_triangle);
}

Result<void> addSketches(Bench& bench,
                         const ScenePtr& scene,
                         const InstancedTargets& targets,
                         const Times& times,
                         SketchInput input) {
    struct Row {
        const char* name;
        Ordering ordering;
        const Sketch* sketch;
        const std::vector<double>* seconds;
    };

    const std::uint64_t unique = countScene(*scene).unique_triangles;
    for (const Row& row :
         {Row{"IAS, ordering triangle",
              Ordering::Triangle,
              &targets.by_triangle,
              &times.by_triangle},
          Row{"IAS, ordering cost", Ordering::Cost, &targets.by_cost, &times.by_cost}}) {
        const Result<LodSourcePtr> source = prepareIas(scene, positionsAlone(), row.ordering);
        if (!source)
            return tl::unexpected(source.error());
        bench.table.tell(std::string(row.name) + ", wall time of its stages",
                         fmt::format("sequences {}, schedule {}",
                                     secondsText((*source)->seconds_sequence),
                                     secondsText((*source)->seconds_schedule)));
        addSketchTime(
            bench.table, *row.sketch, unique, std::array{*row.seconds, times.bunny_anchor});
        const Result<Lod> lod = addSketchQuality(bench.table, **source, *row.sketch, input);
        if (!lod)
            return tl::unexpected(lod.error());
    }
    return {};
}

} // namespace

Result<void> addInstancedRows(Bench& bench,
                              const ScenePtr& scene,
                              const InstancedTargets& targets,
                              SketchInput input) {
    const Result<ScenePtr> expanded = expandScene(*scene, {});
    if (!expanded)
        return tl::unexpected(expanded.error());
    const Result<Times> times = timeAll(bench, scene, *expanded);
    if (!times)
        return tl::unexpected(times.error());
    const SceneCounts counts = countScene(*scene);
    addSpeed(bench, counts, *times, targets.speedup);
    Result<void> added = addSketches(bench, scene, targets, *times, input);
    if (!added || !targets.expanded)
        return added;
    const Result<LodSourcePtr> quadric = prepareQuadric(*expanded, positionsAlone());
    if (!quadric)
        return tl::unexpected(quadric.error());
    bench.table.tell("Quadric, expanded, wall time of its stages",
                     fmt::format("sequences {}, schedule {}",
                                 secondsText((*quadric)->seconds_sequence),
                                 secondsText((*quadric)->seconds_schedule)));
    addSketchTime(bench.table,
                  *targets.expanded,
                  counts.triangles,
                  std::array{times->expanded, times->sphere_anchor});
    const Result<Lod> lod = addSketchQuality(bench.table, **quadric, *targets.expanded, input);
    return lod ? Result<void>() : tl::unexpected(lod.error());
}

} // namespace lodestone::bench
