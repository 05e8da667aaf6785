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
    int turns = 20;
    int frames_a_turn = 50; // counted; 20 * 50: the 100th to the 1,100th
    double budget_s = 0.0;  // > 0: no turn begins after that many seconds; one does anyway
    int size_px = 256;      // square, without antialiasing: vertices are to count, not pixels
};

// Milliseconds of wall time a frame [columns][turns], the mean of a turn: A B C, A B C, ... in one
// context with one camera, so that what drifts falls on all alike.
// columns: the first is framed. Errors: those of the renderer. Main thread.
Result<std::vector<std::vector<double>>> timeFramesInTurns(std::span<const FrameColumn> columns,
                                                           const FrameTurns& turns);

} // namespace lodestone::bench
