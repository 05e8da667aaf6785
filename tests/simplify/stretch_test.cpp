#include "simplify/stretch.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

namespace lodestone {

TEST(Stretch, IsTheLargestScaleWhateverTheRotation) {
    const glm::dmat3 turned(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1.0, 2.0, -1.0)));
    const glm::dmat3 scales(2.0, 0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, -3.0);
    EXPECT_NEAR(longestStretch(scales), 3.0, 1e-12);
    EXPECT_NEAR(longestStretch(turned * scales), 3.0, 1e-12);
    EXPECT_NEAR(longestStretch(turned * 5.0), 5.0, 1e-12);
    EXPECT_EQ(longestStretch(glm::dmat3(0.0)), 0.0);
}

TEST(Stretch, NoDirectionGetsLongerAndOneGetsAsLong) {
    std::mt19937 random(3);
    std::normal_distribution<double> number;
    for (int i = 0; i < 50; ++i) {
        glm::dmat3 linear;
        for (int column = 0; column < 3; ++column)
            linear[column] = {number(random), number(random), number(random)};
        const double longest = longestStretch(linear);
        double found = 0.0;
        for (int k = 0; k < 20'000; ++k) {
            const glm::dvec3 direction(number(random), number(random), number(random));
            found = std::max(found, glm::length(linear * glm::normalize(direction)));
        }
        EXPECT_LE(found, longest * (1.0 + 1e-12));
        EXPECT_GE(found, longest * 0.995);
    }
}

} // namespace lodestone
