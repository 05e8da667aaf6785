#include "scene/thread_priority.h"

#include <tbb/task_scheduler_observer.h>
#ifdef __linux__
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace lodestone {

namespace {

void yieldToOthers() {
#ifdef __linux__
    constexpr int kNice = 10; // about a tenth of the share of a thread that does not yield
    const auto thread = static_cast<id_t>(syscall(SYS_gettid));
    setpriority(PRIO_PROCESS, thread, kNice); // Linux: of that thread alone
#endif
}

} // namespace

struct BackgroundPriority::Helpers final : tbb::task_scheduler_observer {
    Helpers() { observe(true); }

    ~Helpers() override { observe(false); }

    void on_scheduler_entry(bool is_worker) override {
        if (is_worker)
            yieldToOthers();
    }
};

BackgroundPriority::BackgroundPriority() : helpers_(std::make_unique<Helpers>()) {
    yieldToOthers();
}

BackgroundPriority::~BackgroundPriority() = default;

} // namespace lodestone
