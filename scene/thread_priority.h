#pragma once
// Lets the window's thread go first where cores are few.
#include <memory>

namespace lodestone {

// While it lives, the calling thread and the oneTBB workers that help it yield to other threads of
// the program; threads that helped once stay so. No effect where the system knows no priority of a
// single thread. Made and destroyed on the thread that works.
class BackgroundPriority {
public:
    BackgroundPriority();
    ~BackgroundPriority();
    BackgroundPriority(const BackgroundPriority&) = delete;
    BackgroundPriority& operator=(const BackgroundPriority&) = delete;

private:
    struct Helpers;
    std::unique_ptr<Helpers> helpers_;
};

} // namespace lodestone
