#include "app/frame_times.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fmt/core.h>
#include <numeric>

namespace lodestone {

namespace {

// Processor time of the calling thread; 0 where the system does not tell.
double workedMs() {
#ifdef CLOCK_THREAD_CPUTIME_ID
    timespec time{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0)
        return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_nsec) * 1e-6;
#endif
    return 0.0;
}

} // namespace

std::string_view framePartName(FramePart part) {
    constexpr std::array<std::string_view, kFrameParts> kNames{
        "session", "interface", "pictures", "output"};
    return kNames.at(static_cast<std::size_t>(part));
}

void FrameTimes::begin() {
    frame_ = {};
    mark_ = Clock::now();
    worked_before_ms_ = workedMs();
}

void FrameTimes::ended(FramePart part) {
    const Clock::time_point now = Clock::now();
    frame_.parts_ms.at(static_cast<std::size_t>(part)) +=
        std::chrono::duration<double, std::milli>(now - mark_).count();
    mark_ = now;
}

std::optional<std::string> FrameTimes::finish() {
    frame_.time_ms = std::accumulate(frame_.parts_ms.begin(), frame_.parts_ms.end(), 0.0);
    frame_.worked_ms = workedMs() - worked_before_ms_;
    frames_.push_back(frame_);
    if (mark_ - told_ < std::chrono::seconds(1))
        return std::nullopt;
    told_ = mark_;
    std::ranges::sort(frames_, {}, &Frame::time_ms);
    std::string members = told();
    frames_.clear();
    return members;
}

std::string FrameTimes::told() const {
    const auto at = [&](double share) {
        const double place = std::ceil(share * static_cast<double>(frames_.size()));
        return frames_[static_cast<std::size_t>(std::max(1.0, place)) - 1].time_ms;
    };
    const Frame& slowest = frames_.back();
    std::string parts;
    for (std::size_t part = 0; part < kFrameParts; ++part)
        parts += fmt::format(
            "\"{}\":{:.1f},", framePartName(static_cast<FramePart>(part)), slowest.parts_ms[part]);
    return fmt::format(
        "\"count\":{},\"p50_ms\":{:.1f},\"p99_ms\":{:.1f},\"max_ms\":{:.1f},\"slow\":{},"
        "\"slowest\":{{{}\"worked\":{:.1f}}}",
        frames_.size(),
        at(0.5),
        at(0.99),
        slowest.time_ms,
        std::ranges::count_if(frames_, [](const Frame& frame) { return frame.time_ms > kSlowMs; }),
        parts,
        slowest.worked_ms);
}

} // namespace lodestone
