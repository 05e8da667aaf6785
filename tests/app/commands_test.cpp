#include "app/commands.h"
#include "tests/scene/scene_fixtures.h"

#include <array>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace lodestone {

namespace {

Document openedDocument() {
    Document document;
    resetDocument(document, describeScene(fixtures::cubeRowScene(5), {}));
    return document;
}

const Lane& laneOf(const Document& document, std::size_t index) {
    return document.lanes.at(index);
}

// Any edit, valid or not: lanes that are gone, numbers out of range.
class RandomEdits {
public:
    explicit RandomEdits(std::uint32_t seed) : random_(seed) {}

    Command next(const Document& document) {
        switch (below(12)) {
        case 0:
            return AddLane{pickAlgorithm()};
        case 1:
            return DuplicateLane{pickLane(document)};
        case 2:
            return RemoveLane{pickLane(document)};
        case 3:
            return MoveLane{pickLane(document), below(12)};
        case 4:
            return SetLaneAlgorithm{pickLane(document), pickAlgorithm()};
        case 5:
            return SetLaneTarget{pickLane(document), pickTarget()};
        case 6:
            return SetMasterTarget{pickTarget()};
        case 7:
            return FollowMaster{pickLane(document), below(2) == 0};
        case 8:
            return SetOrdering{pickLane(document), static_cast<Ordering>(below(3))};
        case 9:
            return SetImportance{{below(6)}, 0.05 * below(300)};
        case 10:
            return SetLocked{{below(6), below(6)}, below(2) == 0};
        default:
            return SetExportOptions{{static_cast<Instancing>(below(4)), Container::Glb}};
        }
    }

private:
    std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>(random_()) % count;
    }

    LaneId pickLane(const Document& document) {
        if (document.lanes.empty() || below(8) == 0)
            return 9999;
        return document.lanes[below(static_cast<std::uint32_t>(document.lanes.size()))].id;
    }

    std::string pickAlgorithm() {
        constexpr std::array<const char*, 5> kIds = {
            "", "ias", "quadric", "quadric-submesh", "unknown"};
        return kIds.at(below(5));
    }

    Target pickTarget() {
        constexpr std::array<double, 6> kValues = {
            0.0, 0.3, 1.0, 5000.0, -3.0, std::numeric_limits<double>::quiet_NaN()};
        return {static_cast<Target::Kind>(below(4)), kValues.at(below(6))};
    }

    std::mt19937 random_;
};

} // namespace

TEST(Commands, UndoRestoresTheStateBeforeEveryRandomEditAndRedoTheOneAfter) {
    for (std::uint32_t seed = 0; seed < 20; ++seed) {
        Document document = openedDocument();
        RandomEdits edits(seed);
        for (int step = 0; step < 60; ++step) {
            const Edits before = editsOf(document);
            const std::uint64_t revision = document.revision;
            const Command command = edits.next(document);
            applyCommand(document, command);
            const Edits after = editsOf(document);
            ASSERT_EQ(before == after, revision == document.revision)
                << "seed " << seed << " step " << step << " command " << command.index();
            if (before == after)
                continue;
            applyCommand(document, Undo{});
            ASSERT_TRUE(editsOf(document) == before) << "seed " << seed << " step " << step;
            applyCommand(document, Redo{});
            ASSERT_TRUE(editsOf(document) == after) << "seed " << seed << " step " << step;
        }
    }
}

TEST(Commands, UndoingEverythingReturnsToTheOpenedDocumentAndRedoingToTheLast) {
    Document document = openedDocument();
    const Edits first = editsOf(document);
    RandomEdits edits(77);
    for (int step = 0; step < 150; ++step)
        applyCommand(document, edits.next(document));
    const Edits last = editsOf(document);
    ASSERT_FALSE(first == last);
    while (document.history.canUndo())
        applyCommand(document, Undo{});
    EXPECT_TRUE(editsOf(document) == first);
    while (document.history.canRedo())
        applyCommand(document, Redo{});
    EXPECT_TRUE(editsOf(document) == last);
}

TEST(Commands, NothingThatIsNotFiniteOrOutOfRangeReachesASetting) {
    Document document = openedDocument();
    RandomEdits edits(5);
    for (int step = 0; step < 500; ++step) {
        applyCommand(document, edits.next(document));
        ASSERT_LE(document.lanes.size(), 9u);
        for (const double importance : document.importance)
            ASSERT_TRUE(importance >= 0.1 && importance <= 10.0);
        for (const Lane& lane : document.lanes) {
            ASSERT_TRUE(lane.settings.target.value >= 0.0);
            if (lane.settings.target.kind == Target::Kind::Ratio) {
                ASSERT_LE(lane.settings.target.value, 1.0);
            }
        }
    }
}

TEST(Commands, ADragIsOneUndoStepAndTheNextDragAnother) {
    Document document = openedDocument();
    const double start = document.master.value;
    for (int step = 1; step <= 50; ++step)
        applyCommand(document, SetMasterTarget{{Target::Kind::Ratio, 0.2 + 0.01 * step}, 7});
    const double first_drag = document.master.value;
    applyCommand(document, EndDrag{});
    for (int step = 1; step <= 50; ++step)
        applyCommand(document, SetMasterTarget{{Target::Kind::Ratio, 0.7 - 0.01 * step}, 7});
    applyCommand(document, Undo{});
    EXPECT_DOUBLE_EQ(document.master.value, first_drag);
    applyCommand(document, Undo{});
    EXPECT_DOUBLE_EQ(document.master.value, start);
    EXPECT_FALSE(document.history.canUndo());
}

TEST(Commands, TheMasterMovesFollowingLanesOnly) {
    Document document = openedDocument();
    const LaneId own = laneOf(document, 1).id;
    const LaneId following = laneOf(document, 2).id;
    applyCommand(document, SetLaneTarget{own, {Target::Kind::Triangles, 12.0}});
    applyCommand(document, SetMasterTarget{{Target::Kind::Bytes, 5000.0}});
    EXPECT_EQ(document.findLane(own)->settings.target.kind, Target::Kind::Triangles);
    EXPECT_EQ(document.findLane(following)->settings.target.kind, Target::Kind::Bytes);
    applyCommand(document, FollowMaster{own, true});
    EXPECT_EQ(document.findLane(own)->settings.target.kind, Target::Kind::Bytes);
}

TEST(Commands, OnlyWhatABuildDependsOnRaisesALanesRevision) {
    Document document = openedDocument();
    const LaneId id = laneOf(document, 1).id;
    const std::uint64_t revision = laneOf(document, 1).revision;
    applyCommand(document, SetLaneTarget{id, {Target::Kind::Ratio, 0.5}});
    applyCommand(document, SetOrdering{id, Ordering::Cost});
    applyCommand(document, SetImportance{{0}, 3.0});
    EXPECT_EQ(document.findLane(id)->revision, revision);
    applyCommand(document, SetLaneAlgorithm{id, "quadric"});
    const std::uint64_t other = document.findLane(id)->revision;
    EXPECT_GT(other, revision);
    applyCommand(document, Undo{});
    EXPECT_GT(document.findLane(id)->revision, other);
}

TEST(Commands, UndoLeavesCameraAndSelectionAlone) {
    Document document = openedDocument();
    applyCommand(document, SetMasterTarget{{Target::Kind::Ratio, 0.4}});
    applyCommand(document, SetCamera{{10.0, 20.0, 30.0, {1.0, 2.0, 3.0}}});
    applyCommand(document, Select{{{0, kNone}}, Select::Mode::Replace});
    applyCommand(document, Undo{});
    EXPECT_DOUBLE_EQ(document.camera.distance, 30.0);
    EXPECT_EQ(document.selection.size(), 1u);
}

TEST(Commands, SelectingTogglesAndRefusesWhatDoesNotExist) {
    Document document = openedDocument();
    applyCommand(document, Select{{{0, 1}, {0, 2}, {77, kNone}}, Select::Mode::Replace});
    ASSERT_EQ(document.selection.size(), 2u);
    applyCommand(document, Select{{{0, 1}, {0, 3}}, Select::Mode::Toggle});
    const std::vector<SelectedItem> expected{{0, 2}, {0, 3}};
    EXPECT_EQ(document.selection, expected);
}

TEST(Commands, AMissingLaneChangesNothingAndWarnsOnceWithACount) {
    Document document = openedDocument();
    const Edits before = editsOf(document);
    applyCommand(document, RemoveLane{4711});
    applyCommand(document, RemoveLane{4711});
    EXPECT_TRUE(editsOf(document) == before);
    ASSERT_EQ(document.messages.size(), 1u);
    EXPECT_EQ(document.messages[0].severity, Severity::Warning);
    EXPECT_EQ(document.messages[0].count, 2u);
}

TEST(Commands, TheTopMessageIsTheWorstThenTheNewest) {
    Document document;
    report(document, Severity::Error, "first error");
    report(document, Severity::Warning, "warning");
    report(document, Severity::Error, "second error");
    report(document, Severity::Info, "information");
    EXPECT_EQ(topMessage(document)->text, "second error");
    report(document, Severity::Error, "first error");
    EXPECT_EQ(topMessage(document)->text, "first error");
}

TEST(Commands, FirstLanesAreOriginalIasAndQuadricInTheirColours) {
    const Document document = openedDocument();
    ASSERT_EQ(document.lanes.size(), 3u);
    EXPECT_EQ(laneName(laneOf(document, 0).settings), "Original");
    EXPECT_EQ(laneOf(document, 1).settings.algorithm->id, "ias");
    EXPECT_EQ(laneOf(document, 2).settings.algorithm->id, "quadric");
    EXPECT_EQ(laneOf(document, 0).settings.colour, (Rgb{0x9a, 0xa3, 0xaf}));
    EXPECT_EQ(laneOf(document, 1).settings.colour, (Rgb{0x4c, 0xc2, 0xa0}));
    EXPECT_EQ(laneOf(document, 2).settings.colour, (Rgb{0xe3, 0xa4, 0x4d}));
    EXPECT_FALSE(document.dirty());
}

TEST(Commands, AfterAPresetTheActiveLaneSimplifies) {
    Document document = openedDocument();
    const auto active = [&] { return document.findLane(document.active_lane)->settings.algorithm; };
    applyCommand(document, SetLanes{{"vt", "fass"}});
    EXPECT_EQ(active()->id, "vt");
    applyCommand(document, SetLanes{{"", "quadric", "ias"}});
    ASSERT_NE(active(), nullptr);
    EXPECT_EQ(active()->id, "ias");
    applyCommand(document, Undo{});
    ASSERT_NE(active(), nullptr);
    EXPECT_EQ(active()->id, "vt");
    applyCommand(document, SetLanes{{""}});
    EXPECT_EQ(active(), nullptr) << "there is no other";
}

TEST(Commands, TwoLanesOfOneAlgorithmDifferInColour) {
    Document document = openedDocument();
    applyCommand(document, DuplicateLane{laneOf(document, 1).id});
    ASSERT_EQ(document.lanes.size(), 4u);
    EXPECT_EQ(laneOf(document, 2).settings.algorithm, laneOf(document, 1).settings.algorithm);
    EXPECT_FALSE(laneOf(document, 2).settings.colour == laneOf(document, 1).settings.colour);
}

TEST(Commands, FramingAimsAtTheSelection) {
    Document document = openedDocument();
    applyCommand(document, Select{{{0, 4}}, Select::Mode::Replace});
    const Bounds last = selectionBounds(document);
    applyCommand(document, FrameSelection{});
    EXPECT_NEAR(glm::length(document.camera.target - last.center()), 0.0, 1e-9);
    const double near_distance = document.camera.distance;
    applyCommand(document, FrameScene{});
    EXPECT_NEAR(glm::length(document.camera.target - document.bounds.center()), 0.0, 1e-9);
    EXPECT_GT(document.camera.distance, near_distance);
}

} // namespace lodestone
