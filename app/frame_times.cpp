#include "app/frame_times.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace lodestone {

std::optional<std::string> FrameTimes::add(Clock::time_point now, double time_ms) {
    times_ms_.push_back(time_ms);
    if (now - told_ < std::chrono::seconds(1))
        return std::nullopt;
    told_ = now;
    std::ranges::sort(times_ms_);
    const auto at = [&](double share) {
        const double place = std::ceil(share * static_cast<double>(times_ms_.size()));
        return times_ms_[static_cast<std::size_t>(std::max(1.0, place)) - 1];
    };
    std::string told = fmt::format(
        "\"count\":{},\"p50_ms\":{:.1f},\"p99_ms\":{:.1f},\"max_ms\":{:.1f},\"slow\":{}",
        times_ms_.size(),
        at(0.5),
        at(0.99),
        times_ms_.back(),
        std::ranges::count_if(times_ms_, [](double time) { return time > kSlowMs; }));
    times_ms_.clear();
    return told;
}

} // namespace lodestone
