#pragma once
// Inside render/ only: how much of a picture to draw at once where the CPU draws, so that a slice
// takes about the time it is given whatever else the machine does. No GL.
#include <algorithm>
#include <cstdint>

namespace lodestone {

class SlicePace {
public:
    static constexpr double kSliceMs = 10.0;
    static constexpr std::uint64_t kFewest = 5'000;
    static constexpr std::uint64_t kMost = 100'000;

    // For the next slice. left_ms: of the time for pictures; of it at most kSliceMs are planned.
    // Result: kFewest to kMost.
    std::uint64_t trianglesWithin(double left_ms) const {
        const double planned = triangles_per_ms_ * std::clamp(left_ms, 0.0, kSliceMs);
        return static_cast<std::uint64_t>(
            std::clamp(planned, static_cast<double>(kFewest), static_cast<double>(kMost)));
    }

    // What one took, more than 0. Slices become smaller at once, larger by and by.
    void drew(std::uint64_t triangles, double time_ms) {
        constexpr double kShortestMs = 0.01;
        if (triangles < kFewest) // fixed costs: tells little
            return;
        const double seen = static_cast<double>(triangles) / std::max(time_ms, kShortestMs);
        triangles_per_ms_ = seen < triangles_per_ms_ ? seen : 0.5 * (triangles_per_ms_ + seen);
    }

private:
    double triangles_per_ms_ = 5'000.0; // half of what llvmpipe does on two idle cores
};

} // namespace lodestone
