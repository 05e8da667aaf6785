#pragma once
#include "app/cli.h"

#include <chrono>
#include <mutex>

namespace lodestone {

// A bar on a terminal, overwritten in place and removed at the end; silent elsewhere.
// report() from any thread.
class ProgressBar {
public:
    explicit ProgressBar(const CliEnvironment& environment);
    ~ProgressBar(); // removes the bar

    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    // What the next fractions are of: "simplify with ias".
    void stage(std::string label);
    void finish(); // removes the bar, before results are printed
    // For the stage; valid as long as the bar.
    JobContext context();

private:
    void draw(double fraction);
    void clear();

    const CliEnvironment& environment_;
    std::mutex mutex_;
    std::string label_;
    std::chrono::steady_clock::time_point drawn_;
    bool visible_ = false;
};

} // namespace lodestone
