// What the results say of peers.
#include "bench/peer_board.h"

#include <gtest/gtest.h>

namespace lodestone::bench {

namespace {

// A peer that takes half our time at twice our mean distance.
PeerSheet sheet() {
    PeerSheet made;
    made.input = "Input";
    made.files_of_ours = 3;
    made.files_as_predicted = 2;
    PeerRow row;
    row.name = "Peer";
    row.seconds = {1.0, 1.0, 1.0};
    row.time_ratio = 0.5;
    row.ours = {100, 1, 1000, 1000, 0.5, 0.1, 0.01};
    row.theirs = {100, 1, 995, 0, 0.5, 0.2, 0.01};
    made.rows.push_back(row);
    return made;
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

} // namespace

TEST(PeerBoard, SaysWhereAPeerIsBetterAndWhereItIsNot) {
    PeerBoard board;
    board.add(sheet());
    const std::string summary = board.summary();
    EXPECT_TRUE(contains(summary, "- Peer, CPU time: Input 0.5×"));
    EXPECT_FALSE(contains(summary, "Peer, mean distance"));
    EXPECT_FALSE(contains(summary, "Peer, file")); // less than 1 % is a draw
}

TEST(PeerBoard, CountsTheFilesWhoseSizeWasPredicted) {
    PeerBoard board;
    board.add(sheet());
    EXPECT_TRUE(contains(board.summary(), "in 2 of 3 files"));
}

TEST(PeerBoard, TellsWhyAPeerHasNoFigures) {
    PeerSheet made = sheet();
    made.rows[0].failure = "no memory";
    EXPECT_TRUE(contains(PeerBoard::table(made), "failed: no memory"));
    PeerBoard board;
    board.add(std::move(made));
    EXPECT_FALSE(contains(board.summary(), "Input 0.5×"));
}

} // namespace lodestone::bench
