#include "scene/morton.h"

#include <gtest/gtest.h>
#include <limits>
#include <set>

namespace lodestone {
namespace {

TEST(Morton, NeighboursInTheListAreNeighboursInSpace) {
    std::vector<glm::dvec3> points; // a cube of 16 each way, far off, in an order of its own
    for (int i = 0; i < 4096; ++i) {
        const int mixed = i * 1531 % 4096;
        points.emplace_back(1000.0 + mixed % 16, mixed / 16 % 16, mixed / 256);
    }
    const std::vector<std::uint32_t> order = mortonOrder(points);
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), points.size());
    double way = 0.0;
    for (std::size_t i = 1; i < order.size(); ++i)
        way += glm::distance(points[order[i - 1]], points[order[i]]);
    EXPECT_LT(way / 4095.0, 2.0) << "at random it is about 10";
}

TEST(Morton, PointsAtOnePlaceKeepTheirOrder) {
    EXPECT_EQ(mortonOrder(std::vector<glm::dvec3>(3, glm::dvec3(1e300))),
              (std::vector<std::uint32_t>{0, 1, 2}));
    EXPECT_TRUE(mortonOrder({}).empty());
}

TEST(Morton, PlacesThatAreNotFiniteAreListedLikeOthers) {
    const double infinite = std::numeric_limits<double>::infinity();
    const std::vector<glm::dvec3> points{
        {0.0, 0.0, 0.0}, {infinite, 0.0, 0.0}, {-infinite, 0.0, infinite}, {1.0, 1.0, 1.0}};
    const std::vector<std::uint32_t> order = mortonOrder(points);
    EXPECT_EQ(std::set(order.begin(), order.end()).size(), points.size());
}

} // namespace
} // namespace lodestone
