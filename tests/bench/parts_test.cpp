// What a bench that was broken off finds again.
#include "bench/parts.h"
#include "bench/peers/process.h"

#include <fstream>
#include <gtest/gtest.h>

namespace lodestone::bench {

namespace {

const PartOrigin kOrigin{"abc1234 of a day", "5 rounds", 0.0};

Part part() {
    return {"peers: Fire alarms", {kOrigin.commit, kOrigin.how, 12.5}, {{"rows", 3}}};
}

} // namespace

TEST(Parts, WhatIsKeptIsFoundAgain) {
    const ScratchFolder scratch;
    const Parts parts(scratch.path() / "new");
    ASSERT_TRUE(parts.keep(part()));
    const std::optional<Part> found = parts.find("peers: Fire alarms", kOrigin);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->content, part().content);
    EXPECT_EQ(found->origin.seconds, 12.5);
}

TEST(Parts, AnotherCommitOrOtherRoundsDoNotCount) {
    const ScratchFolder scratch;
    const Parts parts(scratch.path());
    ASSERT_TRUE(parts.keep(part()));
    EXPECT_FALSE(parts.find("peers: Fire alarms", {"def5678 of a day", kOrigin.how, 0.0}));
    EXPECT_FALSE(parts.find("peers: Fire alarms", {kOrigin.commit, "one round", 0.0}));
    EXPECT_FALSE(parts.find("peers: Fire", kOrigin));
}

TEST(Parts, OfAProgramWithChangesCountNever) {
    const ScratchFolder scratch;
    const Parts parts(scratch.path());
    Part changed = part();
    changed.origin.commit.clear();
    ASSERT_TRUE(parts.keep(changed));
    EXPECT_FALSE(parts.find(changed.name, changed.origin));
}

TEST(Parts, ADamagedFileIsMeasuredAnew) {
    const ScratchFolder scratch;
    const Parts parts(scratch.path());
    ASSERT_TRUE(parts.keep(part()));
    std::ofstream(std::filesystem::directory_iterator(scratch.path())->path()) << "{\"name\":";
    EXPECT_FALSE(parts.find("peers: Fire alarms", kOrigin));
}

TEST(Parts, AFolderThatCannotBeIsAnError) {
    const Parts parts("/dev/null/parts");
    const Result<void> kept = parts.keep(part());
    ASSERT_FALSE(kept);
    EXPECT_NE(kept.error().message.find("/dev/null/parts"), std::string::npos);
}

} // namespace lodestone::bench
