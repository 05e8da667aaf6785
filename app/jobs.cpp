#include "app/jobs.h"

#include "scene/thread_priority.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

namespace lodestone {

namespace {

using Clock = std::chrono::steady_clock;

// Shared by all job threads; outlives the queue's own members through shared_ptr.
struct Bell {
    std::mutex mutex;
    std::condition_variable changed;
    std::uint64_t finished = 0;
    std::function<void()> wake;

    void ring() {
        {
            const std::lock_guard lock(mutex);
            ++finished;
        }
        changed.notify_all();
        if (wake)
            wake();
    }
};

// What main thread and job thread share.
struct Shared {
    std::atomic<double> progress{0.0};
    std::atomic<bool> finished{false}; // release: `result` is written
    Result<JobResult> result = cancelled();
};

struct Job {
    JobId id = 0;
    JobSpec spec;
    std::shared_ptr<Shared> shared = std::make_shared<Shared>();
    Clock::time_point started;
    std::jthread thread; // joinable once running

    bool running() const { return thread.joinable(); }
};

Result<JobResult> runGuarded(const std::function<Result<JobResult>(const JobContext&)>& work,
                             const JobContext& context) {
    try {
        return work(context);
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::Failed, "not enough memory; close other scenes or programs");
    } catch (const std::exception& exception) {
        return fail(ErrorKind::Failed, exception.what());
    }
}

std::optional<double> remainingSeconds(double progress, double elapsed_s) {
    constexpr double kEnoughProgress = 0.02;
    constexpr double kEnoughSeconds = 0.3;
    if (progress < kEnoughProgress || elapsed_s < kEnoughSeconds)
        return std::nullopt;
    return elapsed_s * (1.0 - progress) / progress;
}

} // namespace

struct JobQueue::Impl {
    std::uint32_t worker_threads = 1;
    std::shared_ptr<Bell> bell = std::make_shared<Bell>();
    std::deque<Job> jobs;      // waiting and running, in the order of start
    std::deque<Job> abandoned; // cancelled, their threads not back yet
    JobId next_id = 1;

    void launch(Job& job) {
        job.started = Clock::now();
        job.thread =
            std::jthread([shared = job.shared, bell = bell, work = std::move(job.spec.run)](
                             const std::stop_token& stop) {
                JobContext context;
                context.stop = stop;
                context.progress = [shared](double fraction) { shared->progress = fraction; };
                const BackgroundPriority priority;
                shared->result = runGuarded(work, context);
                shared->finished.store(true, std::memory_order_release);
                bell->ring();
            });
    }

    void launchWaiting() {
        const auto counts = [](const Job& job) { return job.spec.kind != JobKind::Predict; };
        auto running = static_cast<std::uint32_t>(std::ranges::count_if(
            jobs, [&](const Job& job) { return job.running() && counts(job); }));
        for (Job& job : jobs) {
            if (job.running() || (counts(job) && running >= worker_threads))
                continue;
            launch(job);
            running += counts(job) ? 1 : 0;
        }
    }

    template <class Predicate>
    void cancelIf(const Predicate& matches) {
        for (auto job = jobs.begin(); job != jobs.end();) {
            const auto& no_return = job->spec.no_return;
            if (!matches(*job) || (no_return && !no_return->close())) {
                ++job;
                continue;
            }
            if (job->running()) {
                job->thread.request_stop();
                abandoned.push_back(std::move(*job));
            }
            job = jobs.erase(job);
        }
        launchWaiting();
    }

    void reapAbandoned() {
        std::erase_if(abandoned, [](const Job& job) {
            return job.shared->finished.load(std::memory_order_acquire);
        });
    }
};

JobQueue::JobQueue(std::uint32_t worker_threads, std::function<void()> wake)
    : impl_(std::make_unique<Impl>()) {
    impl_->worker_threads = std::max(worker_threads, 1u);
    impl_->bell->wake = std::move(wake);
}

JobQueue::~JobQueue() {
    for (Job& job : impl_->jobs)
        job.thread.request_stop();
}

JobId JobQueue::start(JobSpec spec) {
    if (spec.kind != JobKind::Export && spec.kind != JobKind::Predict)
        cancel(spec.lane, spec.kind);
    Job job;
    job.id = impl_->next_id++;
    job.spec = std::move(spec);
    impl_->jobs.push_back(std::move(job));
    impl_->launchWaiting();
    return impl_->jobs.back().id;
}

void JobQueue::cancel(JobId id) {
    impl_->cancelIf([id](const Job& job) { return id == 0 || job.id == id; });
}

void JobQueue::cancel(LaneId lane, JobKind kind) {
    impl_->cancelIf([&](const Job& job) { return job.spec.lane == lane && job.spec.kind == kind; });
}

std::vector<FinishedJob> JobQueue::poll() {
    impl_->reapAbandoned();
    std::vector<FinishedJob> finished;
    for (auto job = impl_->jobs.begin(); job != impl_->jobs.end();) {
        if (!job->shared->finished.load(std::memory_order_acquire)) {
            ++job;
            continue;
        }
        job->thread.join();
        finished.push_back({job->id,
                            job->spec.kind,
                            job->spec.lane,
                            job->spec.revision,
                            std::move(job->spec.label),
                            std::move(job->shared->result)});
        job = impl_->jobs.erase(job);
    }
    impl_->launchWaiting();
    return finished;
}

std::vector<JobStatus> JobQueue::status() const {
    std::vector<JobStatus> result;
    result.reserve(impl_->jobs.size());
    for (const Job& job : impl_->jobs) {
        JobStatus status;
        status.id = job.id;
        status.kind = job.spec.kind;
        status.lane = job.spec.lane;
        status.label = job.spec.label;
        status.running = job.running();
        if (status.running) {
            status.progress = std::clamp(job.shared->progress.load(), 0.0, 1.0);
            status.elapsed_s = std::chrono::duration<double>(Clock::now() - job.started).count();
            status.remaining_s = remainingSeconds(status.progress, status.elapsed_s);
        }
        result.push_back(std::move(status));
    }
    return result;
}

bool JobQueue::idle() const {
    return impl_->jobs.empty();
}

void JobQueue::waitForFinished(std::uint32_t timeout_ms) {
    const auto any_finished = [this] {
        return std::ranges::any_of(impl_->jobs,
                                   [](const Job& job) { return job.shared->finished.load(); });
    };
    std::unique_lock lock(impl_->bell->mutex);
    impl_->bell->changed.wait_for(lock, std::chrono::milliseconds(timeout_ms), any_finished);
}

} // namespace lodestone
