#include "bench/timing.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <tbb/global_control.h>

namespace lodestone::bench {

double cpuSeconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wallSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

Spread spreadOf(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t middle = values.size() / 2;
    const double median =
        values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
    return {median, values.front(), values.back()};
}

namespace {

Result<double> timeRound(const Contender& contender) {
    std::vector<double> seconds;
    for (int run = 0; run < contender.runs_a_round; ++run) {
        const double start = cpuSeconds();
        const Result<std::shared_ptr<const void>> made = contender.work();
        seconds.push_back(cpuSeconds() - start);
        if (!made)
            return tl::unexpected(made.error());
    }
    return spreadOf(std::move(seconds)).median;
}

} // namespace

Result<std::vector<std::vector<double>>> timeInTurns(std::span<const Contender> contenders,
                                                     int rounds) {
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<std::vector<double>> seconds(contenders.size());
    for (int round = 0; round < rounds; ++round)
        for (std::size_t c = 0; c < contenders.size(); ++c) {
            const Result<double> taken = timeRound(contenders[c]);
            if (!taken)
                return tl::unexpected(taken.error());
            seconds[c].push_back(*taken);
        }
    return seconds;
}

double medianRatio(std::span<const double> numerator, std::span<const double> denominator) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < numerator.size(); ++i)
        ratios.push_back(numerator[i] / denominator[i]);
    return spreadOf(std::move(ratios)).median;
}

} // namespace lodestone::bench
