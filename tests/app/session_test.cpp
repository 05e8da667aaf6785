#include "app/session.h"
#include "tests/scene/scene_fixtures.h"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

namespace lodestone {

namespace {

constexpr double kPatience_s = 60.0;

class SessionTest : public ::testing::Test {
protected:
    SessionTest() {
        folder = std::filesystem::temp_directory_path() /
                 ("lodestone_session_test_" + std::to_string(getpid()));
        std::filesystem::create_directories(folder);
    }

    ~SessionTest() override { std::filesystem::remove_all(folder); }

    Session::Options options() const {
        Session::Options result;
        result.recent_file = folder / "config" / "recent";
        result.log_file = folder / "log";
        return result;
    }

    void send(Session& session, Command command) {
        CommandQueue queue;
        queue.push(std::move(command));
        session.update(queue);
        ASSERT_TRUE(session.updateUntilIdle(kPatience_s));
    }

    std::filesystem::path folder;
};

const Message& lastMessage(const Session& session) {
    return session.document().messages.back();
}

} // namespace

TEST_F(SessionTest, AnOpenedSampleShowsOriginalIasAndQuadricAtTwentyPercent) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const Document& document = session.document();
    ASSERT_EQ(document.lanes.size(), 3u);
    for (const Lane& lane : document.lanes) {
        EXPECT_EQ(lane.status.state, LaneState::Ready);
        ASSERT_TRUE(lane.status.lod);
    }
    EXPECT_EQ(document.lanes[0].status.numbers.triangles, 2240u);
    EXPECT_LE(document.lanes[1].status.numbers.triangles, 448u);
    EXPECT_LE(document.lanes[2].status.numbers.triangles, 448u);
    EXPECT_FALSE(document.dirty());
}

TEST_F(SessionTest, AnExportedLaneHasThePredictedSizeAndOpensAgain) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const Lane ias = session.document().lanes[1];
    const std::filesystem::path file = folder / "ias.glb";
    send(session, Export{ias.id, file});
    ASSERT_TRUE(std::filesystem::exists(file)) << lastMessage(session).text;
    EXPECT_EQ(std::filesystem::file_size(file), ias.status.numbers.predicted_bytes);
    EXPECT_EQ(session.document().last_export, file);
    send(session, OpenScene{file});
    EXPECT_EQ(session.document().counts.triangles, ias.status.numbers.triangles);
    ASSERT_EQ(session.document().recent.size(), 1u);
    EXPECT_EQ(Session(options()).document().recent.size(), 1u);
}

TEST_F(SessionTest, AFileThatCannotBeReadIsAMessageAndTheOpenSceneStays) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const ScenePtr before = session.document().scene;
    send(session, OpenScene{folder / "missing.glb"});
    EXPECT_EQ(session.document().scene, before);
    EXPECT_EQ(session.document().load_state, LoadState::Loaded);
    EXPECT_EQ(lastMessage(session).severity, Severity::Error);
    EXPECT_NE(lastMessage(session).text.find("missing.glb"), std::string::npos);
}

TEST_F(SessionTest, AnExportThatCannotBeWrittenIsAMessage) {
    Session session(options());
    send(session, OpenSample{"chair"});
    send(session, Export{session.document().lanes[1].id, folder / "no" / "folder.glb"});
    EXPECT_EQ(lastMessage(session).severity, Severity::Error);
    EXPECT_FALSE(session.document().last_export.has_value());
}

TEST_F(SessionTest, AMeasuredDistanceBelongsToTheLodShown) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const LaneId id = session.document().lanes[1].id;
    send(session, MeasureLane{id});
    ASSERT_TRUE(session.document().findLane(id)->status.distance.has_value());
    EXPECT_GT(session.document().findLane(id)->status.distance->hausdorff, 0.0);
    send(session, SetLaneTarget{id, {Target::Kind::Ratio, 0.6}});
    EXPECT_FALSE(session.document().findLane(id)->status.distance.has_value());
}

TEST_F(SessionTest, TheHeatMapsModeMakesAMapOfEveryLodShown) {
    Session session(options());
    send(session, OpenSample{"chair"});
    DisplayOptions view = session.document().view;
    view.compare = CompareMode::HeatMap;
    send(session, SetView{view});
    const auto expect_current = [&] {
        for (const Lane& lane : session.document().lanes) {
            ASSERT_TRUE(lane.status.error_map.lod);
            EXPECT_EQ(lane.status.error_map.lod_revision, lane.status.lod_revision);
            EXPECT_EQ(lane.status.error_map.lod->triangles, lane.status.lod->triangles);
            EXPECT_EQ(lane.status.error_map.peak > 0.0, lane.settings.algorithm != nullptr);
        }
    };
    expect_current();
    const double peak = session.document().lanes[1].status.error_map.peak;
    EXPECT_GE(errorMapFull(session.document()), peak);
    send(session, SetMasterTarget{{Target::Kind::Ratio, 0.08}});
    expect_current();
    EXPECT_GT(session.document().lanes[1].status.error_map.peak, peak);
}

TEST_F(SessionTest, ATargetInPixelsFollowsTheCameraAndUndoLeavesIt) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const LaneId id = session.document().lanes[1].id;
    const auto triangles = [&] {
        return session.document().findLane(id)->status.numbers.triangles;
    };
    const std::uint64_t at_first = triangles();
    send(session, SetMasterPixels{4.0});
    const std::uint64_t near = triangles();
    CameraState camera = session.document().camera;
    camera.distance *= 4.0;
    send(session, SetCamera{camera});
    EXPECT_LT(triangles(), near);
    camera.distance *= 0.25;
    send(session, SetCamera{camera});
    EXPECT_EQ(triangles(), near);
    send(session, Undo{});
    EXPECT_EQ(triangles(), at_first);
    EXPECT_FALSE(session.document().master_px || session.document().lanes[1].settings.error_px);
    const std::size_t warnings = session.document().messages.size();
    send(session, SetLanePixels{id, 0.0});
    EXPECT_EQ(session.document().messages.size(), warnings + 1);
}

TEST_F(SessionTest, TheLogIsJsonLinesThatFollowTheLanes) {
    {
        Session session(options());
        send(session, OpenSample{"chair"});
        const LaneId id = session.document().lanes[1].id;
        send(session, SetLaneTarget{id, {Target::Kind::Triangles, 1000.0}});
    }
    std::ifstream stream(folder / "log");
    std::string line;
    std::uint64_t last_triangles = 0;
    std::string last_state;
    while (std::getline(stream, line)) {
        const nlohmann::json json = nlohmann::json::parse(line);
        if (json["kind"] != "lane" || json["algorithm"] != "ias")
            continue;
        last_triangles = json["triangles"];
        last_state = json["state"];
    }
    EXPECT_EQ(last_state, "ready");
    EXPECT_LE(last_triangles, 1000u);
    EXPECT_GT(last_triangles, 448u);
}

TEST_F(SessionTest, ASizeForOtherExportOptionsIsWhatAnExportWithThemWrites) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const LaneId id = session.document().lanes[1].id;
    const ExportOptions nodes{Instancing::Nodes, Container::Glb};
    EXPECT_EQ(session.predictedSize(id, nodes).bytes, 0u) << "no frame waits for it";
    ASSERT_TRUE(session.updateUntilIdle(30.0));
    const std::uint64_t predicted = session.predictedSize(id, nodes).bytes;
    send(session, SetExportOptions{nodes});
    send(session, Export{id, folder / "nodes.glb"});
    EXPECT_EQ(std::filesystem::file_size(folder / "nodes.glb"), predicted);
}

TEST_F(SessionTest, EqualBytesMovesEveryFollowingLaneBelowTheSize) {
    Session session(options());
    send(session, OpenSample{"chair"});
    const double bytes =
        0.6 * static_cast<double>(session.document().lanes[0].status.numbers.predicted_bytes);
    send(session, SetMasterTarget{{Target::Kind::Bytes, bytes}});
    for (const Lane& lane : session.document().lanes) {
        if (!lane.settings.algorithm || !lane.status.numbers.note.empty())
            continue;
        EXPECT_LE(static_cast<double>(lane.status.numbers.predicted_bytes), bytes);
    }
}

} // namespace lodestone
