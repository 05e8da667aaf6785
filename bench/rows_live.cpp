#include "bench/rows_live.h"

#include "bench/table.h"
#include "bench/timing.h"
#include "simplify/algorithm.h"

#include <array>
#include <fmt/core.h>
#include <functional>
#include <ostream>

namespace lodestone::bench {

namespace {

struct SliderTimes {
    std::vector<double> wall_s; // [steps]
    std::vector<double> cpu_s;
};

Result<void> addStep(SliderTimes& times, const std::function<Result<void>()>& step) {
    const double wall = wallSeconds();
    const double cpu = cpuSeconds();
    Result<void> done = step();
    times.wall_s.push_back(wallSeconds() - wall);
    times.cpu_s.push_back(cpuSeconds() - cpu);
    return done;
}

// "12.3 ms (41 ms)"
std::string medianAndWorst(const std::vector<double>& seconds) {
    const Spread spread = spreadOf(seconds);
    return fmt::format("{} ({})", secondsText(spread.median), secondsText(spread.max));
}

// As a lane does when its main parameter's slider is dragged.
Result<SliderTimes> dragParameter(const Algorithm& algorithm, const LodSource& lane) {
    constexpr int kSteps = 12;
    const ParameterInfo& main = algorithm.parameters.front();
    const ByteModel bytes(lane.scene(), {});
    // Distances: from 0.1 to 3 % of the diagonal; what lies beyond is no more of a model.
    const bool is_distance = main.id == "distance" || main.id == "radius";
    const double most = is_distance ? 3.0 : main.maximum;
    SliderTimes times;
    for (int k = 1; k <= kSteps; ++k) {
        const double value = most * k / kSteps;
        const Result<void> stepped = addStep(times, [&]() -> Result<void> {
            const auto source =
                algorithm.prepareLike(lane, {{std::string(main.id), value}}, {}, {});
            if (!source)
                return tl::unexpected(source.error());
            const Resolved at = (*source)->resolve({Target::Kind::Ratio, 0.2}, bytes);
            (*source)->readOut(at.position, nullptr);
            return {};
        });
        if (!stepped)
            return tl::unexpected(stepped.error());
    }
    return times;
}

// As a lane does when its triangle slider is dragged.
Result<SliderTimes> dragTarget(const LodSource& lane) {
    constexpr int kSteps = 18;
    const ByteModel bytes(lane.scene(), {});
    SliderTimes times;
    for (int k = 0; k < kSteps; ++k) {
        const double ratio = 0.9 - 0.05 * k;
        const Result<void> stepped = addStep(times, [&]() -> Result<void> {
            const Resolved at = lane.resolve({Target::Kind::Ratio, ratio}, bytes);
            lane.readOut(at.position, nullptr);
            return {};
        });
        if (!stepped)
            return tl::unexpected(stepped.error());
    }
    return times;
}

} // namespace

Result<void> writeLiveSliders(std::ostream& out, const ScenePtr& scene) {
    out << "One step, median (worst): of the main parameter at twelve values, the method run anew; "
           "of the target from 90 to 5 % of the triangles, searched for.\n\n"
           "| method | parameter moves | CPU time | target moves | CPU time |\n"
           "|---|---|---|---|---|\n";
    for (const std::string_view id : {"vt", "fad", "ivdd", "ss", "vtd", "fass"}) {
        const Algorithm& algorithm = *findAlgorithm(id);
        const Result<LodSourcePtr> lane = algorithm.prepare(scene, {}, {}, {});
        if (!lane)
            return tl::unexpected(lane.error());
        const Result<SliderTimes> parameter = dragParameter(algorithm, **lane);
        if (!parameter)
            return tl::unexpected(parameter.error());
        const Result<SliderTimes> target = dragTarget(**lane);
        if (!target)
            return tl::unexpected(target.error());
        out << fmt::format("| {} | {} | {} | {} | {} |\n",
                           algorithm.short_name,
                           medianAndWorst(parameter->wall_s),
                           medianAndWorst(parameter->cpu_s),
                           medianAndWorst(target->wall_s),
                           medianAndWorst(target->cpu_s));
    }
    return {};
}

} // namespace lodestone::bench
