#pragma once
// One piece of work beside the frames.
#include <functional>
#include <memory>
#include <string>
#include <thread>

namespace lodestone {

// Starts at once, on a thread of its own that yields to the window's. Move-only; destroying it
// waits for the work. Main thread.
class BackgroundWork {
public:
    explicit BackgroundWork(std::function<void()> work); // may throw

    bool finished() const; // what the work wrote can be read
    // Of finished work: a line; empty if nothing went wrong.
    const std::string& failure() const;

private:
    struct Shared;
    std::shared_ptr<Shared> shared_;
    std::jthread thread_;
};

} // namespace lodestone
