#pragma once
// The six point-cloud methods: the paper's protocol, all of them at equal triangles, and following
// a slider.
#include "bench/figures.h"

#include <iosfwd>

namespace lodestone::bench {

enum class PointCloudExtent : std::uint8_t {
    Quick, // one parameter a method
    Full,  // the paper's four
};

// Writes a Markdown table for each wanted input. Frames are drawn off screen: the 100th to the
// 1,100th of each, in turns, as many of them as fit 200 seconds an input. What fails is told on
// stderr and left out. Returns the exit code. Main thread.
int writePointCloud(std::ostream& out,
                    Inputs& inputs,
                    PointCloudExtent extent,
                    const TitleFilter& wanted);

} // namespace lodestone::bench
