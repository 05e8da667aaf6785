#pragma once
// CPU seconds of things that are compared: one thread, taken in turns, so that what else the
// machine does falls on all alike.
#include "scene/result.h"

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace lodestone::bench {

double cpuSeconds();  // of the process
double wallSeconds(); // since some fixed moment

struct Spread {
    double median = 0.0;
    double min = 0.0;
    double max = 0.0;
};

Spread spreadOf(std::vector<double> values); // at least one

// What is timed. Returns what it made, which is let go after the clock has stopped.
using Work = std::function<Result<std::shared_ptr<const void>>()>;

struct Contender {
    Work work;
    int runs_a_round = 1; // short work runs more often; a round's figure is the median
};

// CPU seconds [contenders][rounds], on one thread: A B C, A B C, ...
// Errors: those of the works.
Result<std::vector<std::vector<double>>> timeInTurns(std::span<const Contender> contenders,
                                                     int rounds);

// Median over the rounds of numerator over denominator: what drifts from round to round cancels.
double medianRatio(std::span<const double> numerator, std::span<const double> denominator);

} // namespace lodestone::bench
