#include "bench/quality.h"
#include "bench/rows.h"
#include "scene/expand.h"

#include <fmt/core.h>
#include <tbb/global_control.h>

namespace lodestone::bench {

Result<void> addDistanceRows(Bench& bench) {
    const Result<ScenePtr> bunny = anchorBunny(bench.inputs);
    if (!bunny)
        return tl::unexpected(bunny.error());
    const Result<ScenePtr> expanded = expandScene(**bunny, {});
    if (!expanded)
        return tl::unexpected(expanded.error());
    const Result<LodSourcePtr> quadric = prepareQuadric(*expanded, {});
    if (!quadric)
        return tl::unexpected(quadric.error());
    const ScenePtr scene = (*quadric)->scene();
    const Lod lod =
        lodAtTriangles(**quadric, 0.2 * static_cast<double>(countScene(*scene).triangles));
    const tbb::global_control two_threads(tbb::global_control::max_allowed_parallelism, 2);
    std::vector<double> wall; // [rounds] seconds a million samples
    std::vector<double> cpu;
    for (int round = 0; round < bench.rounds; ++round) {
        const double wall_start = wallSeconds();
        const double cpu_start = cpuSeconds();
        const Result<Distance> distance = distanceToFull({scene.get(), &lod});
        if (!distance)
            return tl::unexpected(distance.error());
        const double millions = 1e-6 * static_cast<double>(distance->samples);
        wall.push_back((wallSeconds() - wall_start) / millions);
        cpu.push_back((cpuSeconds() - cpu_start) / millions);
    }
    const Spread spread = spreadOf(wall);
    bench.table.atMost("bunny at 20 %: a million samples with exact maxima, two threads",
                       {spread.median,
                        1.0,
                        secondsText(spread),
                        secondsText(1.0),
                        fmt::format("{:.2f} million samples a second", 1.0 / spread.median)});
    bench.table.tell("the same: CPU of both threads", secondsText(spreadOf(cpu)));
    return {};
}

} // namespace lodestone::bench
