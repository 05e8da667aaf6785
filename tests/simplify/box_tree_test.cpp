#include "simplify/collapse/box_tree.h"
#include "simplify/measure/triangle.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace lodestone {
namespace {

class BoxTreeTest : public testing::Test {
protected:
    glm::vec3 anywhere() {
        std::uniform_real_distribution<float> along(-1.0f, 1.0f);
        const float x = along(random_);
        const float y = along(random_);
        return {x, y, along(random_)};
    }

    std::vector<BoxTree::Corners> someTriangles(std::size_t count) {
        std::vector<BoxTree::Corners> triangles;
        for (std::size_t t = 0; t < count; ++t) {
            const glm::vec3 at = anywhere() * glm::vec3(10.0f, 1.0f, 1.0f); // as a branch is
            triangles.push_back({at, at + 0.3f * anywhere(), at + 0.3f * anywhere()});
        }
        return triangles;
    }

    static float nearestOfAll(const std::vector<BoxTree::Corners>& triangles,
                              const glm::vec3& point,
                              const BoxTree::Placement& placement) {
        double nearest2 = std::numeric_limits<double>::infinity();
        for (const BoxTree::Corners& corners : triangles) {
            Triangle placed;
            for (std::size_t k = 0; k < 3; ++k)
                placed[k] = glm::dvec3(placement.linear * corners[k] + placement.offset);
            nearest2 = std::min(nearest2, squaredDistance(glm::dvec3(point), placed));
        }
        return static_cast<float>(nearest2);
    }

private:
    std::mt19937 random_{7};
};

const glm::mat3 kTurn{
    glm::rotate(glm::mat4(1.0f), 0.7f, glm::normalize(glm::vec3(1.0f, 2.0f, 3.0f)))};

TEST_F(BoxTreeTest, FindsTheNearestUnderEveryPlacement) {
    const std::vector<BoxTree::Corners> triangles = someTriangles(500);
    const BoxTree tree(triangles);
    const glm::mat3 shear(1.0f, 0.0f, 0.0f, 1.5f, 1.0f, 0.0f, 0.0f, 0.5f, 1.0f);
    const auto scale = [](float x, float y, float z) {
        return glm::mat3(glm::scale(glm::mat4(1.0f), glm::vec3(x, y, z)));
    };
    for (const glm::mat3& linear : {glm::mat3(1.0f),
                                    kTurn * 3.0f,
                                    kTurn * scale(1.0f, 0.01f, 20.0f),
                                    scale(-1.0f, 1.0f, 1.0f),
                                    kTurn * shear,
                                    kTurn * scale(1.0f, 0.0f, 1.0f)}) {
        const BoxTree::Placement placement(linear, glm::vec3(1.0f, -2.0f, 3.0f));
        for (int i = 0; i < 50; ++i) {
            const glm::vec3 point = linear * (12.0f * anywhere()) + placement.offset;
            const float nearest2 = nearestOfAll(triangles, point, placement);
            EXPECT_EQ(tree.nearest(point, placement, std::numeric_limits<float>::max()), nearest2);
            EXPECT_EQ(tree.nearest(point, placement, 0.5f * nearest2), 0.5f * nearest2) << "limit";
        }
    }
}

TEST_F(BoxTreeTest, WithoutTrianglesNothingIsNear) {
    const BoxTree tree({});
    const BoxTree::Placement placement(glm::mat3(1.0f), glm::vec3(0.0f));
    EXPECT_EQ(tree.nearest(glm::vec3(0.0f), placement, 4.0f), 4.0f);
}

TEST_F(BoxTreeTest, WhatIsNotANumberIsNotNear) {
    const BoxTree tree(someTriangles(20));
    const float no_number = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(tree.nearest(glm::vec3(0.0f), {glm::mat3(no_number), glm::vec3(0.0f)}, 4.0f), 4.0f);
    EXPECT_EQ(tree.nearest(glm::vec3(no_number), {glm::mat3(1.0f), glm::vec3(0.0f)}, 4.0f), 4.0f);
}

} // namespace
} // namespace lodestone
