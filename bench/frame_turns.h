#pragma once
// How long levels of detail take to draw, off screen and in turns.
#include "scene/lod.h"
#include "scene/result.h"

#include <memory>
#include <span>
#include <vector>

namespace lodestone::bench {

struct FrameColumn {
    ScenePtr scene; // whose submeshes `lod` replaces
    std::shared_ptr<const Lod> lod;
};

struct FrameTurns {
    int warm_up = 100; // frames of each column before the first turn, not counted
    int turns = 100;
    int frames_a_turn = 10; // counted; 100 * 10: the 100th to the 1,100th
    double budget_s = 0.0;  // > 0: no turn begins that many seconds after the second; two do anyway
    int size_px = 256;      // square, without antialiasing: vertices are to count, not pixels
};

// Milliseconds a frame, the mean of each turn.
struct FrameTimes {
    std::vector<double> wall_ms;
    std::vector<double> cpu_ms; // of all threads; where the CPU draws, what else is busy stays out
};

// [columns]; A B C, A B C, ... in one context with one camera, so that what drifts falls on all
// alike. columns: the first is framed. Errors: those of the renderer. Main thread.
Result<std::vector<FrameTimes>> timeFramesInTurns(std::span<const FrameColumn> columns,
                                                  const FrameTurns& turns);

} // namespace lodestone::bench
