#include "simplify/collapse/chart_mask.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <vector>

namespace lodestone {
namespace {

void addSquare(std::vector<ChartMask::Triangle>& to, glm::vec2 low, float size) {
    const glm::vec2 x(size, 0.0f);
    const glm::vec2 y(0.0f, size);
    to.push_back({low, low + x, low + x + y});
    to.push_back({low, low + x + y, low + y});
}

// A chart like the letter L, from 0 to 1, a fifth wide; 1,800 triangles.
std::vector<ChartMask::Triangle> corner() {
    constexpr int kSide = 50;
    constexpr int kWide = 10;
    std::vector<ChartMask::Triangle> chart;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < (y < kWide ? kSide : kWide); ++x)
            addSquare(
                chart, glm::vec2(static_cast<float>(x), static_cast<float>(y)) * 0.02f, 0.02f);
    return chart;
}

TEST(ChartMask, HoldsItsTrianglesAndALittleAroundThem) {
    const ChartMask mask(corner());
    EXPECT_TRUE(mask.holds({0.1f, 0.1f}));
    EXPECT_TRUE(mask.holds({0.9f, 0.1f}));
    EXPECT_TRUE(mask.holds({0.1f, 1.0f}));
    EXPECT_TRUE(mask.holds({0.5f, 0.205f}));
    EXPECT_FALSE(mask.holds({0.5f, 0.23f}));
    EXPECT_FALSE(mask.holds({0.6f, 0.6f}));
    EXPECT_FALSE(mask.holds({-0.1f, 0.1f}));
    EXPECT_FALSE(mask.holds({1.1f, 0.1f}));
}

TEST(ChartMask, HoldsEverythingWhereNothingIsCovered) {
    EXPECT_TRUE(ChartMask().holds({5.0f, 5.0f}));
    const glm::vec2 dot(0.3f, 0.3f); // a palette's texel
    EXPECT_TRUE(ChartMask(std::vector<ChartMask::Triangle>{{dot, dot, dot}}).holds({0.9f, 0.9f}));
}

TEST(ChartMask, ATiledTextureHasNoCharts) {
    std::vector<ChartMask::Triangle> wall = corner();
    EXPECT_TRUE(ChartMask(wall).covers());
    for (int k = 0; k < 100; ++k)
        addSquare(wall, {0.0f, 0.0f}, 0.9f);
    EXPECT_FALSE(ChartMask(wall).covers());
    EXPECT_TRUE(ChartMask(wall).holds({5.0f, 5.0f}));
}

TEST(ChartMask, NonsenseOfTheFileDoesNotCount) {
    std::vector<ChartMask::Triangle> triangles = corner();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    triangles.insert(triangles.begin(), {glm::vec2(nan, 0.0f), {100.0f, 0.0f}, {0.0f, 100.0f}});
    const ChartMask mask(triangles);
    EXPECT_TRUE(mask.holds({0.1f, 0.9f}));
    EXPECT_FALSE(mask.holds({0.6f, 0.6f}));
    EXPECT_FALSE(mask.holds({nan, nan}));
}

} // namespace
} // namespace lodestone
