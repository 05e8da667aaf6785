#pragma once
// How long frames took and what they spent it on, told once a second.
#include <array>
#include <chrono>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lodestone {

// What a frame does, in this order; some of it twice (see WindowLoop).
enum class FramePart : std::uint8_t { Session, Interface, Pictures, Output };
constexpr std::size_t kFrameParts = 4;

std::string_view framePartName(FramePart part); // "session", "interface", ...

// Main thread.
class FrameTimes {
public:
    using Clock = std::chrono::steady_clock;

    void begin(); // with the events that cause the frame
    // What passed since the last call of the two belongs to that part.
    void ended(FramePart part);
    // The picture is out: ends the frame. At most once a second: the inside of a JSON object about
    // the frames since the last time: "count", "p50_ms", "p99_ms", "max_ms", "slow", the number
    // above kSlowMs, and "slowest", an object of the milliseconds that the slowest of them took for
    // each part, and in "worked" for how long this thread did not wait for others.
    std::optional<std::string> finish();

    static constexpr double kSlowMs = 100.0;

private:
    struct Frame {
        double time_ms = 0.0;
        std::array<double, kFrameParts> parts_ms{};
        double worked_ms = 0.0;
    };

    std::string told() const; // sorted frames

    std::vector<Frame> frames_; // since told_
    Frame frame_;               // the one under way
    Clock::time_point mark_;
    double worked_before_ms_ = 0.0;
    Clock::time_point told_;
};

} // namespace lodestone
