#pragma once
#include <functional>
#include <stop_token>

namespace lodestone {

// What long work gets from its caller. Loops look at `stop` at least every 10 ms.
struct JobContext {
    std::stop_token stop;
    std::function<void(double)> progress; // 0..1, may be empty; called from any thread

    bool stopRequested() const { return stop.stop_requested(); }

    void report(double fraction) const {
        if (progress)
            progress(fraction);
    }
};

} // namespace lodestone
