#include "bench/rows.h"
#include "scene/expand.h"

#include <fmt/core.h>
#include <limits>
#include <random>
#include <tbb/global_control.h>

namespace lodestone::bench {

namespace {

enum class Previous : std::uint8_t { Given, None };

std::vector<std::uint64_t> randomPositions(const LodSource& source, std::size_t count) {
    std::mt19937_64 random(1);
    std::vector<std::uint64_t> positions;
    for (std::size_t i = 0; i < count; ++i)
        positions.push_back(random() % source.positionCount());
    return positions;
}

struct ReadOutTimes {
    std::vector<double> wall; // [positions] seconds
    std::vector<double> cpu;  // of both threads together
};

// Reads out each position after the one before it. Each time is the fastest of three passes: what
// else the machine does is no part of it.
ReadOutTimes
timeReadOuts(const LodSource& source, std::span<const std::uint64_t> positions, Previous previous) {
    constexpr int kPasses = 3;
    const tbb::global_control two_threads(tbb::global_control::max_allowed_parallelism, 2);
    const std::vector<double> unknown(positions.size(), std::numeric_limits<double>::max());
    ReadOutTimes fastest{unknown, unknown};
    for (int pass = 0; pass < kPasses; ++pass) {
        Lod last = source.readOut(0, nullptr);
        for (std::size_t i = 0; i < positions.size(); ++i) {
            const double wall_start = wallSeconds();
            const double cpu_start = cpuSeconds();
            Lod lod = source.readOut(positions[i], previous == Previous::Given ? &last : nullptr);
            fastest.cpu[i] = std::min(fastest.cpu[i], cpuSeconds() - cpu_start);
            fastest.wall[i] = std::min(fastest.wall[i], wallSeconds() - wall_start);
            last = std::move(lod);
        }
    }
    return fastest;
}

struct ReadOutLimits {
    double median = 0.0; // seconds
    double worst = 0.0;
    std::size_t positions = 0;
};

void addRows(Table& table, const std::string& name, const LodSource& source, ReadOutLimits limits) {
    const std::vector<std::uint64_t> positions = randomPositions(source, limits.positions);
    for (const Previous previous : {Previous::Given, Previous::None}) {
        const ReadOutTimes times = timeReadOuts(source, positions, previous);
        const Spread spread = spreadOf(times.wall);
        const std::string what =
            name + (previous == Previous::Given ? ", from the LOD before" : ", from nothing");
        table.atMost(what + ": median",
                     {spread.median,
                      limits.median,
                      secondsText(spread),
                      secondsText(limits.median),
                      fmt::format("{} random positions", limits.positions)});
        table.atMost(
            what + ": worst",
            {spread.max, limits.worst, secondsText(spread.max), secondsText(limits.worst), ""});
        table.tell(what + ": CPU of both threads", secondsText(spreadOf(times.cpu)));
    }
}

} // namespace

Result<void> addReadOutRows(Bench& bench) {
    const Result<ScenePtr> maple = bench.inputs.own("maple");
    if (!maple)
        return tl::unexpected(maple.error());
    const Result<LodSourcePtr> ias = prepareIas(*maple, {}, Ordering::Triangle);
    if (!ias)
        return tl::unexpected(ias.error());
    addRows(bench.table, "maple, IAS", **ias, {2e-3, 2e-3, 300});
    const Result<ScenePtr> expanded = expandScene(**maple, {});
    if (!expanded)
        return tl::unexpected(expanded.error());
    const Result<LodSourcePtr> quadric = prepareQuadric(*expanded, {});
    if (!quadric)
        return tl::unexpected(quadric.error());
    addRows(bench.table, "maple expanded, Quadric", **quadric, {33e-3, 60e-3, 60});
    return {};
}

} // namespace lodestone::bench
