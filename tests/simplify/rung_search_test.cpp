#include "simplify/pointcloud/rung_search.h"

#include <atomic>
#include <cmath>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

RungSearch searchOf(std::uint64_t last, std::function<double(std::uint64_t)> excess) {
    RungSearch search;
    search.last = last;
    search.excess = std::move(excess);
    return search;
}

} // namespace

TEST(RungSearch, EveryRungIsFoundWhereTheMeasureTurnsThere) {
    for (std::uint64_t turn = 1; turn <= 100; ++turn) {
        const auto steep = [turn](std::uint64_t rung) { return rung < turn ? 3.0 : -40.0; };
        const RungBracket found = searchRungs(searchOf(100, steep));
        EXPECT_EQ(found.fine, turn - 1);
        EXPECT_EQ(found.coarse, turn);
    }
}

TEST(RungSearch, RungZeroPastTheLimitNeedsNoSearch) {
    const RungBracket found = searchRungs(searchOf(100, [](std::uint64_t) { return -1.0; }));
    EXPECT_EQ(found.fine, 0u);
    EXPECT_EQ(found.coarse, 0u);
}

TEST(RungSearch, NoRungPastTheLimitIsSaid) {
    const auto slow = [](std::uint64_t rung) { return 5.0 - 1e-3 * static_cast<double>(rung); };
    const RungBracket found = searchRungs(searchOf(4096, slow));
    EXPECT_EQ(found.fine, 4096u);
    EXPECT_EQ(found.coarse, 4097u);
}

TEST(RungSearch, SmoothMeasuresNeedFewTries) {
    std::atomic<int> tries = 0;
    RungSearch search = searchOf(4096, [&](std::uint64_t rung) {
        ++tries;
        return 4.0 * std::exp(-static_cast<double>(rung) / 1500.0) - 1.0; // zero at 2079
    });
    search.first = {1500, 2800};
    EXPECT_EQ(searchRungs(search).coarse, 2080u);
    EXPECT_LE(tries, 13);
    tries = 0;
    search.tolerance = 0.005;
    const RungBracket found = searchRungs(search);
    EXPECT_LE(found.coarse, 2080u + 7u);
    EXPECT_LE(tries, 9);
}

TEST(RungSearch, NoiseStillEndsAtATurn) {
    const auto noisy = [](std::uint64_t rung) {
        const double noise = static_cast<double>(rung * 2654435761u % 1000u) / 1000.0 - 0.5;
        return 3.0 - 0.01 * static_cast<double>(rung) + noise;
    };
    const RungBracket found = searchRungs(searchOf(1000, noisy));
    EXPECT_GT(noisy(found.fine), 0.0);
    EXPECT_LE(noisy(found.fine + 1), 0.0);
    EXPECT_LE(noisy(found.coarse), 0.0);
    EXPECT_GE(noisy(found.coarse), noisy(found.fine + 1));
}

} // namespace lodestone
