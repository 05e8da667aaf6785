#include "app/jobs.h"

#include <atomic>
#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace lodestone {

namespace {

using Milliseconds = std::chrono::duration<double, std::milli>;
using Flag = std::shared_ptr<std::atomic<bool>>;

Flag makeFlag() {
    return std::make_shared<std::atomic<bool>>(false);
}

Result<JobResult> distanceResult(double hausdorff) {
    Distance distance;
    distance.hausdorff = hausdorff;
    return JobResult(distance);
}

JobSpec quickJob(LaneId lane, JobKind kind, double hausdorff) {
    JobSpec spec;
    spec.kind = kind;
    spec.lane = lane;
    spec.revision = 3;
    spec.run = [hausdorff](const JobContext&) { return distanceResult(hausdorff); };
    return spec;
}

// Runs until `release` or, if it looks at its token, until stopped.
JobSpec heldJob(LaneId lane, JobKind kind, const Flag& release, const Flag& stopped) {
    JobSpec spec;
    spec.kind = kind;
    spec.lane = lane;
    spec.run = [release, stopped](const JobContext& context) -> Result<JobResult> {
        context.report(0.25);
        while (!*release) {
            if (stopped && context.stopRequested()) {
                *stopped = true;
                return cancelled();
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return distanceResult(-1.0);
    };
    return spec;
}

std::vector<FinishedJob> pollUntil(JobQueue& jobs, std::size_t count) {
    std::vector<FinishedJob> finished;
    while (finished.size() < count) {
        jobs.waitForFinished(100);
        for (FinishedJob& job : jobs.poll())
            finished.push_back(std::move(job));
    }
    return finished;
}

} // namespace

TEST(Jobs, AResultComesBackOnceWithTheRevisionItWasStartedFor) {
    JobQueue jobs(2);
    const JobId id = jobs.start(quickJob(5, JobKind::Measure, 1.5));
    const std::vector<FinishedJob> finished = pollUntil(jobs, 1);
    ASSERT_EQ(finished.size(), 1u);
    EXPECT_EQ(finished[0].id, id);
    EXPECT_EQ(finished[0].lane, 5u);
    EXPECT_EQ(finished[0].revision, 3u);
    EXPECT_DOUBLE_EQ(std::get<Distance>(*finished[0].result).hausdorff, 1.5);
    EXPECT_TRUE(jobs.poll().empty());
    EXPECT_TRUE(jobs.idle());
}

TEST(Jobs, TheNewestOfALaneAndKindReplacesTheOlder) {
    JobQueue jobs(4);
    const Flag release = makeFlag();
    const Flag stopped = makeFlag();
    jobs.start(heldJob(1, JobKind::Prepare, release, stopped));
    const JobId other_lane = jobs.start(quickJob(2, JobKind::Prepare, 2.0));
    const JobId newest = jobs.start(quickJob(1, JobKind::Prepare, 7.0));
    const std::vector<FinishedJob> finished = pollUntil(jobs, 2);
    EXPECT_EQ(finished.size(), 2u);
    for (const FinishedJob& job : finished)
        EXPECT_TRUE(job.id == newest || job.id == other_lane);
    EXPECT_TRUE(jobs.idle());
    while (!*stopped)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST(Jobs, ExportsOfOneLaneAllRun) {
    JobQueue jobs(1);
    jobs.start(quickJob(1, JobKind::Export, 1.0));
    jobs.start(quickJob(1, JobKind::Export, 2.0));
    EXPECT_EQ(pollUntil(jobs, 2).size(), 2u);
}

TEST(Jobs, CancellingReturnsAtOnceEvenIfTheWorkDoesNotListen) {
    const Flag release = makeFlag();
    {
        JobQueue jobs(1);
        const JobId deaf = jobs.start(heldJob(1, JobKind::Load, release, nullptr));
        const auto start = std::chrono::steady_clock::now();
        jobs.cancel(deaf);
        EXPECT_TRUE(jobs.idle());
        EXPECT_LT(Milliseconds(std::chrono::steady_clock::now() - start).count(), 10.0);
        // Its thread does not keep the next job waiting.
        jobs.start(quickJob(1, JobKind::Load, 4.0));
        const std::vector<FinishedJob> finished = pollUntil(jobs, 1);
        EXPECT_DOUBLE_EQ(std::get<Distance>(*finished[0].result).hausdorff, 4.0);
        *release = true;
    }
}

TEST(Jobs, AnExportIsCancelledUntilItPassesThePointOfNoReturn) {
    JobQueue jobs(2);
    const Flag release = makeFlag();
    const Flag stopped = makeFlag();
    JobSpec working = heldJob(1, JobKind::Export, release, stopped);
    working.no_return = std::make_shared<PointOfNoReturn>();
    JobSpec writing = heldJob(1, JobKind::Export, release, nullptr);
    writing.no_return = std::make_shared<PointOfNoReturn>();
    ASSERT_TRUE(writing.no_return->pass());
    const auto no_return = working.no_return;
    jobs.start(std::move(working));
    const JobId as_good_as_done = jobs.start(std::move(writing));
    jobs.cancel(0);
    ASSERT_EQ(jobs.status().size(), 1u);
    EXPECT_EQ(jobs.status()[0].id, as_good_as_done);
    EXPECT_FALSE(no_return->pass()) << "it would replace the file all the same";
    *release = true;
    const std::vector<FinishedJob> finished = pollUntil(jobs, 1);
    EXPECT_EQ(finished[0].id, as_good_as_done);
    EXPECT_TRUE(finished[0].result.has_value());
}

TEST(Jobs, NoMoreThanTheWorkersRunAndTheRestWait) {
    JobQueue jobs(2);
    const Flag release = makeFlag();
    for (LaneId lane = 1; lane <= 5; ++lane)
        jobs.start(heldJob(lane, JobKind::Prepare, release, nullptr));
    const std::vector<JobStatus> status = jobs.status();
    ASSERT_EQ(status.size(), 5u);
    EXPECT_TRUE(status[0].running && status[1].running);
    EXPECT_FALSE(status[2].running || status[3].running || status[4].running);
    *release = true;
    EXPECT_EQ(pollUntil(jobs, 5).size(), 5u);
}

TEST(Jobs, ProgressIsSeenWhileAJobRuns) {
    JobQueue jobs(1);
    const Flag release = makeFlag();
    jobs.start(heldJob(1, JobKind::Prepare, release, nullptr));
    while (jobs.status()[0].progress < 0.25)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_DOUBLE_EQ(jobs.status()[0].progress, 0.25);
    *release = true;
    pollUntil(jobs, 1);
}

TEST(Jobs, AnExceptionBecomesAnError) {
    JobQueue jobs(1);
    JobSpec spec;
    spec.run = [](const JobContext&) -> Result<JobResult> { throw std::runtime_error("broken"); };
    jobs.start(std::move(spec));
    const std::vector<FinishedJob> finished = pollUntil(jobs, 1);
    ASSERT_FALSE(finished[0].result.has_value());
    EXPECT_EQ(finished[0].result.error().message, "broken");
}

TEST(Jobs, TheWakeFunctionIsCalledForEveryFinishedJob) {
    const auto woken = std::make_shared<std::atomic<int>>(0);
    {
        JobQueue jobs(2, [woken] { ++*woken; });
        jobs.start(quickJob(1, JobKind::Prepare, 0.0));
        jobs.start(quickJob(2, JobKind::Prepare, 0.0));
        pollUntil(jobs, 2);
    }
    EXPECT_EQ(*woken, 2);
}

} // namespace lodestone
