#include "app/signals.h"

#include "scene/result.h"

#include <ctime>
#include <unistd.h>

namespace lodestone {

SignalWatcher::SignalWatcher() {
    sigemptyset(&signals_);
    sigaddset(&signals_, SIGINT);
    sigaddset(&signals_, SIGTERM);
    pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    watcher_ = std::jthread(
        [signals = signals_, source = source_](const std::stop_token& finished) mutable {
            constexpr timespec kPatience{0, 50'000'000};
            while (!finished.stop_requested()) {
                if (sigtimedwait(&signals, nullptr, &kPatience) < 0)
                    continue;
                if (source.stop_requested())
                    _exit(exitCode(ErrorKind::Cancelled));
                source.request_stop();
            }
        });
}

} // namespace lodestone
