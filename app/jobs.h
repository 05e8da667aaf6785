#pragma once
// Slow work beside the main thread. A job owns its inputs and captures nothing else.
#include "app/document.h"
#include "app/point_of_no_return.h"
#include "scene/export.h"

#include <functional>
#include <memory>
#include <variant>

namespace lodestone {

struct PreparedSource {
    LodSourcePtr source;
    std::shared_ptr<const ByteModel> bytes; // made for source->scene()
};

// A LOD of a source that no frame can wait for, and what is known of it.
struct ReadOut {
    std::shared_ptr<const Lod> lod;
    Resolved resolved;
    std::uint64_t predicted_bytes = 0;
    double error_estimate = 0.0;
    double seconds = 0.0;
};

struct PredictedSizes {
    ScenePtr scene;
    ExportOptions options;
    std::shared_ptr<const ByteModel> model;
};

using JobResult = std::variant<LoadedScene,
                               PreparedSource,
                               ExportReport,
                               Distance,
                               PredictedSizes,
                               ReadOut,
                               ErrorMap,
                               LaneTexturesPtr>;

struct JobSpec {
    JobKind kind = JobKind::Load;
    LaneId lane = kNoLane;
    std::uint64_t revision = 0; // of what the result is for; handed back unchanged
    std::string label;          // "Building IAS"
    std::function<Result<JobResult>(const JobContext&)> run;
    // What `run` asks before it does what cannot be undone; null: it does no such thing.
    std::shared_ptr<PointOfNoReturn> no_return = nullptr;
};

struct FinishedJob {
    JobId id = 0;
    JobKind kind = JobKind::Load;
    LaneId lane = kNoLane;
    std::uint64_t revision = 0;
    std::string label;
    Result<JobResult> result;
};

// Newest wins: a job that is started cancels an older one of the same lane and kind, except
// exports and predictions, which all run. A cancelled job leaves status() at once and its result is
// dropped; if it does not look at its stop token (a library call) its thread is left alone until it
// returns. One that has passed its point of no return is not cancelled: it is as good as done. All
// members: main thread.
class JobQueue {
public:
    // worker_threads: how many jobs run at a time, >= 1, predictions, which are short, not counted.
    // wake: called from the job's thread when it has finished; may be empty.
    explicit JobQueue(std::uint32_t worker_threads, std::function<void()> wake = {});
    ~JobQueue(); // cancels everything and waits for the threads

    JobQueue(const JobQueue&) = delete;
    JobQueue& operator=(const JobQueue&) = delete;

    JobId start(JobSpec spec);
    void cancel(JobId id); // 0: all. Returns at once
    void cancel(LaneId lane, JobKind kind);
    std::vector<FinishedJob> poll();       // in the order of start; starts waiting jobs
    std::vector<JobStatus> status() const; // waiting and running, in the order of start
    bool idle() const;
    // Sleeps until some job has finished or timeout_ms have passed.
    void waitForFinished(std::uint32_t timeout_ms);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lodestone
