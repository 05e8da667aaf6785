#pragma once
// How long frames took, told once a second.
#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace lodestone {

class FrameTimes {
public:
    using Clock = std::chrono::steady_clock;

    // One frame, from the events that caused it to the picture that is out. At most once a second:
    // the inside of a JSON object about the frames since the last time, "count", "p50_ms",
    // "p99_ms", "max_ms" and "slow", the number above kSlowMs.
    std::optional<std::string> add(Clock::time_point now, double time_ms);

    static constexpr double kSlowMs = 100.0;

private:
    std::vector<double> times_ms_; // since told_
    Clock::time_point told_;
};

} // namespace lodestone
