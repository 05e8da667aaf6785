// What the micro-benchmarks call slower.
#include "bench/micro/ratios.h"

#include <fstream>
#include <gtest/gtest.h>

namespace lodestone::bench {

namespace {

HotPath hotPath(const std::string& name, double ratio) {
    return {name, {}, ratio};
}

std::filesystem::path temporaryFile(const std::string& name) {
    return std::filesystem::path(testing::TempDir()) / name;
}

} // namespace

TEST(HotPaths, MoreThanAQuarterSlowerThanBeforeIsNamed) {
    const Ratios before{{"a", 1.0}, {"b", 1.0}, {"c", 2.0}};
    const std::vector<HotPath> now{
        hotPath("a", 1.24), hotPath("b", 1.26), hotPath("c", 0.5), hotPath("new", 100.0)};
    const std::vector<std::string> slower = slowerThan(before, now);
    ASSERT_EQ(slower.size(), 1U);
    EXPECT_TRUE(slower[0].starts_with("b:"));
}

TEST(HotPaths, ABaselineIsReadBackAsItWasWritten) {
    const std::filesystem::path path = temporaryFile("baseline.json");
    const std::vector<HotPath> written{hotPath("a", 1.5), hotPath("b", 0.25)};
    ASSERT_TRUE(writeBaseline(path, written));
    const Result<Ratios> read = readBaseline(path);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(*read, (Ratios{{"a", 1.5}, {"b", 0.25}}));
}

TEST(HotPaths, ABaselineThatIsNoObjectOfPositiveNumbersIsRefused) {
    const std::filesystem::path path = temporaryFile("broken_baseline.json");
    for (const char* text : {"", "[]", "{\"a\": \"1\"}", "{\"a\": 0}", "{\"a\": -1}"}) {
        std::ofstream(path) << text;
        const Result<Ratios> read = readBaseline(path);
        ASSERT_FALSE(read) << text;
        EXPECT_NE(read.error().message.find("broken_baseline.json"), std::string::npos);
    }
}

} // namespace lodestone::bench
