#include "render/background_work.h"

#include "scene/thread_priority.h"

#include <atomic>
#include <new>

namespace lodestone {

struct BackgroundWork::Shared {
    std::atomic<bool> finished{false}; // release: `failure` and the work's results are written
    std::string failure;
};

BackgroundWork::BackgroundWork(std::function<void()> work)
    : shared_(std::make_shared<Shared>()), thread_([shared = shared_, work = std::move(work)] {
          try {
              const BackgroundPriority priority;
              work();
          } catch (const std::bad_alloc&) {
              shared->failure = "not enough memory to draw this scene; close other programs";
          } catch (const std::exception& exception) {
              shared->failure = exception.what();
          }
          shared->finished.store(true, std::memory_order_release);
      }) {}

bool BackgroundWork::finished() const {
    return shared_->finished.load(std::memory_order_acquire);
}

const std::string& BackgroundWork::failure() const {
    return shared_->failure;
}

} // namespace lodestone
