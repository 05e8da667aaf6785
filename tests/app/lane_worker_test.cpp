#include "app/commands.h"
#include "app/lane_worker.h"
#include "scene/generate.h"
#include "tests/app/fake_algorithm.h"
#include "tests/scene/scene_fixtures.h"

#include <chrono>
#include <gtest/gtest.h>
#include <thread>

namespace lodestone {

namespace {

class LaneWorkerTest : public ::testing::Test {
protected:
    LaneWorkerTest() {
        fixtures::resetFakeBuilds();
        resetDocument(document, describeScene(fixtures::cubeRowScene(5), {}));
        document.lanes.clear();
    }

    ~LaneWorkerTest() override { fixtures::fakeBuilds().hold = false; }

    LaneId addFakeLane(const Algorithm& algorithm = fixtures::fakeAlgorithm()) {
        document.lanes.push_back(makeLane(document, &algorithm));
        return document.lanes.back().id;
    }

    Lane& lane(LaneId id) { return *document.findLane(id); }

    void frame() {
        for (FinishedJob& finished : jobs.poll())
            worker.commit(document, finished);
        worker.refresh(document);
    }

    void settle() {
        frame();
        while (!jobs.idle()) {
            jobs.waitForFinished(50);
            frame();
        }
    }

    // Until a build has begun.
    void waitForStart(int count) {
        while (fixtures::fakeBuilds().started < count)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }

    Document document;
    JobQueue jobs{2};
    LaneWorker worker{jobs};
};

} // namespace

TEST_F(LaneWorkerTest, ALaneIsBuiltInTheBackgroundAndThenShowsItsTarget) {
    const LaneId id = addFakeLane();
    fixtures::fakeBuilds().hold = true;
    frame();
    waitForStart(1);
    frame();
    EXPECT_EQ(lane(id).status.state, LaneState::Building);
    EXPECT_FALSE(lane(id).status.lod);
    fixtures::fakeBuilds().hold = false;
    settle();
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
    // 5 cubes of 12 triangles, 20 %.
    EXPECT_EQ(lane(id).status.numbers.triangles, 12u);
    EXPECT_DOUBLE_EQ(lane(id).status.numbers.ratio, 0.2);
    EXPECT_GT(lane(id).status.numbers.predicted_bytes, 0u);
}

TEST_F(LaneWorkerTest, ALaneThatSlidesShowsWhatIsBetweenLodsAndTheTargetsOwnAfterwards) {
    const Algorithm* const ias = findAlgorithm("ias");
    ASSERT_TRUE(ias);
    resetDocument(document, describeScene(generateScene("chair").value(), {}));
    document.lanes.clear();
    const LaneId id = addFakeLane(*ias);
    settle();
    const auto position_at = [&](double ratio) {
        return lane(id)
            .status.source->resolve({Target::Kind::Ratio, ratio}, ByteModel(document.scene, {}))
            .position;
    };
    for (const double ratio : {0.7, 0.69}) {
        applyCommand(document, SlideLane{id, ratio, 7});
        frame();
        EXPECT_LT(lane(id).status.lod->position, position_at(ratio)) << "the finer LOD's";
    }
    const auto slid = lane(id).status.lod;
    frame();
    EXPECT_EQ(lane(id).status.lod, slid) << "nothing moved";
    applyCommand(document, EndDrag{});
    frame();
    EXPECT_NE(lane(id).status.lod, slid);
    EXPECT_EQ(lane(id).status.lod->position, position_at(0.69));
    applyCommand(document, Undo{});
    EXPECT_FALSE(document.history.canUndo()) << "the whole way is one step";
}

TEST_F(LaneWorkerTest, AOneShotLaneFollowsATargetInAJobAndKeepsItsPictureMeanwhile) {
    const LaneId id = addFakeLane(fixtures::fakeOneShotAlgorithm());
    settle();
    const auto shown = lane(id).status.lod;
    ASSERT_TRUE(shown);
    for (const double triangles : {30.0, 40.0}) {
        applyCommand(document, SetLaneTarget{id, {Target::Kind::Triangles, triangles}});
        frame();
        EXPECT_FALSE(jobs.idle()) << "no frame waits for it";
    }
    EXPECT_TRUE(lane(id).status.lod);
    settle();
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
    EXPECT_EQ(lane(id).status.numbers.triangles, 40u) << "the newest target wins";
    EXPECT_GT(lane(id).status.numbers.predicted_bytes, 0u);
    EXPECT_EQ(fixtures::fakeBuilds().started, 1) << "a target needs no other build";
}

TEST_F(LaneWorkerTest, ATargetIsFollowedInTheSameFrameWithoutAJob) {
    const LaneId id = addFakeLane();
    settle();
    for (const double ratio : {0.9, 0.5, 0.1, 0.7, 0.0, 1.0}) {
        applyCommand(document, SetLaneTarget{id, {Target::Kind::Ratio, ratio}});
        frame();
        EXPECT_DOUBLE_EQ(lane(id).status.numbers.ratio, ratio);
        EXPECT_TRUE(jobs.idle());
    }
    EXPECT_EQ(fixtures::fakeBuilds().started, 1);
}

TEST_F(LaneWorkerTest, NothingIsReadOutAgainWhileNothingChanges) {
    const LaneId id = addFakeLane();
    settle();
    const std::uint64_t revision = lane(id).status.lod_revision;
    EXPECT_FALSE(worker.refresh(document));
    EXPECT_EQ(lane(id).status.lod_revision, revision);
}

TEST_F(LaneWorkerTest, LanesThatWouldBuildTheSameShareOneSource) {
    const LaneId first = addFakeLane();
    const LaneId second = addFakeLane();
    lane(second).settings.target.value = 0.5;
    settle();
    EXPECT_EQ(fixtures::fakeBuilds().started, 1);
    EXPECT_EQ(lane(first).status.source, lane(second).status.source);
    EXPECT_DOUBLE_EQ(lane(second).status.numbers.ratio, 0.5);
}

TEST_F(LaneWorkerTest, ANewerSettingStopsTheOlderBuildAndItsResultIsDropped) {
    const LaneId id = addFakeLane();
    fixtures::fakeBuilds().hold = true;
    frame();
    waitForStart(1);
    applyCommand(document, SetLaneParameter{id, "strength", 4.0});
    frame();
    waitForStart(2);
    while (fixtures::fakeBuilds().stopped < 1)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    fixtures::fakeBuilds().hold = false;
    settle();
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
    EXPECT_EQ(fixtures::fakeBuilds().finished, 1);
}

TEST_F(LaneWorkerTest, TheLastPictureStaysWhileANewBuildRuns) {
    const LaneId id = addFakeLane();
    settle();
    const auto shown = lane(id).status.lod;
    fixtures::fakeBuilds().hold = true;
    applyCommand(document, SetLaneParameter{id, "strength", 9.0});
    frame();
    EXPECT_NE(lane(id).status.state, LaneState::Ready);
    EXPECT_EQ(lane(id).status.lod, shown);
}

TEST_F(LaneWorkerTest, ADraggedParameterFinishesAndShowsTheBuildUnderWayAndThenTheNewest) {
    const LaneId id = addFakeLane();
    settle();
    const auto first = lane(id).status.source;
    fixtures::fakeBuilds().hold = true;
    constexpr DragKey kDrag = 7;
    applyCommand(document, SetLaneParameter{id, "strength", 2.0, kDrag});
    frame();
    waitForStart(2);
    for (const double strength : {3.0, 4.0, 5.0}) {
        applyCommand(document, SetLaneParameter{id, "strength", strength, kDrag});
        frame();
    }
    EXPECT_EQ(fixtures::fakeBuilds().started, 2) << "every move began a build";
    fixtures::fakeBuilds().hold = false;
    while (lane(id).status.source == first) { // while the mouse is still held
        jobs.waitForFinished(50);
        frame();
    }
    EXPECT_EQ(fixtures::fakeBuilds().stopped, 0);
    settle();
    EXPECT_EQ(fixtures::fakeBuilds().started, 3) << "the newest, and nothing between";
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
}

TEST_F(LaneWorkerTest, TheEndOfADragStopsABuildForAnEarlierPlace) {
    const LaneId id = addFakeLane();
    settle();
    fixtures::fakeBuilds().hold = true;
    applyCommand(document, SetLaneParameter{id, "strength", 2.0, 7});
    frame();
    waitForStart(2);
    applyCommand(document, SetLaneParameter{id, "strength", 3.0, 7});
    applyCommand(document, EndDrag{});
    frame();
    waitForStart(3);
    while (fixtures::fakeBuilds().stopped < 1)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    fixtures::fakeBuilds().hold = false;
    settle();
    EXPECT_EQ(fixtures::fakeBuilds().stopped, 1);
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
}

TEST_F(LaneWorkerTest, UndoFindsTheEarlierBuildAgain) {
    const LaneId id = addFakeLane();
    settle();
    applyCommand(document, SetLaneParameter{id, "strength", 9.0});
    settle();
    applyCommand(document, Undo{});
    settle();
    EXPECT_EQ(fixtures::fakeBuilds().started, 2);
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
}

TEST_F(LaneWorkerTest, AnotherScheduleNeedsNoBuild) {
    const LaneId id = addFakeLane();
    settle();
    applyCommand(document, SetImportance{{0}, 5.0});
    settle();
    EXPECT_EQ(fixtures::fakeBuilds().started, 1);
    EXPECT_EQ(fixtures::fakeBuilds().rescheduled, 1);
    const auto& source = dynamic_cast<const fixtures::FakeSource&>(*lane(id).status.source);
    EXPECT_EQ(source.schedule().importance, std::vector<double>{5.0});
}

TEST_F(LaneWorkerTest, ASlowScheduleIsMadeInAJobAndTheNewestOneIsShownInTheEnd) {
    fixtures::fakeBuilds().slow_schedule = true;
    const LaneId id = addFakeLane();
    settle();
    for (int step = 1; step <= 20; ++step) {
        applyCommand(document, SetImportance{{0}, 1.0 + 0.1 * step, 7});
        frame();
    }
    settle();
    const auto& source = dynamic_cast<const fixtures::FakeSource&>(*lane(id).status.source);
    ASSERT_EQ(source.schedule().importance.size(), 1u);
    EXPECT_DOUBLE_EQ(source.schedule().importance[0], 3.0);
    EXPECT_EQ(fixtures::fakeBuilds().started, 1);
}

TEST_F(LaneWorkerTest, AFailedBuildStaysFailedUntilRetried) {
    const LaneId id = addFakeLane();
    fixtures::fakeBuilds().fail = true;
    settle();
    EXPECT_EQ(lane(id).status.state, LaneState::Failed);
    EXPECT_EQ(lane(id).status.failure, "fake: told to fail");
    settle();
    EXPECT_EQ(fixtures::fakeBuilds().started, 1);
    fixtures::fakeBuilds().fail = false;
    worker.retry(id);
    settle();
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
}

TEST_F(LaneWorkerTest, ARemovedLaneStopsItsBuild) {
    const LaneId id = addFakeLane();
    fixtures::fakeBuilds().hold = true;
    frame();
    waitForStart(1);
    applyCommand(document, RemoveLane{id});
    frame();
    EXPECT_TRUE(jobs.idle());
    while (fixtures::fakeBuilds().stopped < 1)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

TEST_F(LaneWorkerTest, ACancelledBuildWaitsForRetry) {
    const LaneId id = addFakeLane();
    fixtures::fakeBuilds().hold = true;
    frame();
    waitForStart(1);
    jobs.cancel(id, JobKind::Prepare);
    worker.markCancelled(document, id);
    frame();
    EXPECT_EQ(lane(id).status.state, LaneState::Failed);
    EXPECT_TRUE(jobs.idle());
}

TEST_F(LaneWorkerTest, SteppingMovesAlongTheSameSequenceBothWays) {
    const LaneId id = addFakeLane();
    settle();
    applyCommand(document, StepCollapses{id, 5});
    frame();
    EXPECT_EQ(lane(id).status.numbers.triangles, 7u);
    applyCommand(document, StepCollapses{id, -8});
    frame();
    EXPECT_EQ(lane(id).status.numbers.triangles, 15u);
    applyCommand(document, StepCollapses{id, 1000});
    frame();
    EXPECT_EQ(lane(id).status.numbers.triangles, 0u);
    applyCommand(document, SetLaneTarget{id, {Target::Kind::Ratio, 0.5}});
    frame();
    EXPECT_EQ(lane(id).status.numbers.triangles, 30u);
}

TEST_F(LaneWorkerTest, TheOriginalLaneShowsTheSceneItself) {
    Lane original;
    original.id = document.next_lane_id++;
    document.lanes.push_back(original);
    frame();
    const LaneStatus& status = lane(original.id).status;
    EXPECT_EQ(status.state, LaneState::Ready);
    EXPECT_EQ(status.scene, document.scene);
    EXPECT_EQ(status.numbers.triangles, 60u);
}

TEST_F(LaneWorkerTest, ExportOptionsChangeThePredictedSizeAndNotTheLod) {
    const LaneId id = addFakeLane();
    settle();
    const auto lod = lane(id).status.lod;
    const std::uint64_t before = lane(id).status.numbers.predicted_bytes;
    applyCommand(document, SetExportOptions{{Instancing::Expand, Container::Glb}});
    frame();
    EXPECT_FALSE(jobs.idle()) << "no frame waits for the prediction";
    EXPECT_EQ(lane(id).status.lod, lod) << "the last good picture stays";
    settle();
    EXPECT_EQ(lane(id).status.state, LaneState::Ready);
    EXPECT_EQ(lane(id).status.lod, lod);
    EXPECT_NE(lane(id).status.numbers.predicted_bytes, before);
}

} // namespace lodestone
