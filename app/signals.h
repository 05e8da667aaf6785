#pragma once
#include <csignal>
#include <stop_token>
#include <thread>

namespace lodestone {

// Turns Ctrl+C and SIGTERM into a stop request; the second one ends the process at once. Made
// before any other thread, so that all of them inherit the blocked signals.
class SignalWatcher {
public:
    SignalWatcher();

    std::stop_token token() const { return source_.get_token(); }

private:
    sigset_t signals_{};
    std::stop_source source_;
    std::jthread watcher_;
};

} // namespace lodestone
