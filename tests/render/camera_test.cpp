#include "render/camera.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {
namespace {

Bounds boxBounds(const glm::dvec3& low, const glm::dvec3& high) {
    Bounds bounds;
    bounds.add(low);
    bounds.add(high);
    return bounds;
}

glm::dvec3 project(const OrbitCamera& camera, double aspect, const glm::dvec3& point) {
    const glm::dvec4 clip =
        projectionMatrix(camera, aspect) * viewMatrix(camera) * glm::dvec4(point, 1.0);
    return glm::dvec3(clip) / clip.w;
}

TEST(OrbitCamera, FramingPutsEveryCornerInsideTheView) {
    const Bounds bounds = boxBounds({-1e6, 2.0, 3.0}, {-1e6 + 40.0, 4.0, 11.0});
    for (const double aspect : {0.4, 1.0, 2.5})
        for (const bool orthographic : {false, true}) {
            OrbitCamera camera;
            camera.orthographic = orthographic;
            frameCamera(camera, bounds, aspect);
            for (int corner = 0; corner < 8; ++corner) {
                const glm::dvec3 point((corner & 1) ? bounds.max.x : bounds.min.x,
                                       (corner & 2) ? bounds.max.y : bounds.min.y,
                                       (corner & 4) ? bounds.max.z : bounds.min.z);
                const glm::dvec3 ndc = project(camera, aspect, point);
                for (int c = 0; c < 3; ++c)
                    EXPECT_LT(std::abs(ndc[c]), 1.0) << "corner " << corner << " axis " << c;
            }
        }
}

// A tripod's feet and top: fills a fraction of its box only, from most sides.
ScenePtr tripods() {
    auto geometry = std::make_shared<Geometry>();
    geometry->positions = {{0, 4, 0}, {1, 0, 0}, {-0.5, 0, 0.8}, {-0.5, 0, -0.8}, {50, 50, 50}};
    geometry->indices = {0, 1, 2, 0, 2, 3}; // the last vertex belongs to no triangle
    auto scene = std::make_shared<Scene>();
    scene->submeshes.push_back({"tripod", {{PrimitiveMode::Triangles, geometry}}});
    scene->instances.resize(2);
    scene->instances[1].transform[3] = glm::dvec4(3.0, 0.5, -2.0, 1.0);
    scene->instances[1].transform[0] *= -1.5;
    return scene;
}

TEST(OrbitCamera, FramedModelSpansTheSameShareFromEverySideInTheMiddle) {
    const ScenePtr scene = tripods();
    Bounds drawn;
    std::vector<glm::dvec3> vertices;
    for (const Instance& instance : scene->instances)
        for (const std::uint32_t index : scene->submeshes[0].primitives[0].geometry->indices) {
            const glm::vec3& local = scene->submeshes[0].primitives[0].geometry->positions[index];
            vertices.emplace_back(instance.transform * glm::dvec4(local, 1.0));
            drawn.add(vertices.back());
        }
    const FramePoints frame = framePoints(*scene, drawn);
    EXPECT_EQ(frame.bounds.max, drawn.max);
    for (const double aspect : {0.5, 1.0, 1.9})
        for (int turn = 0; turn < 24; ++turn) {
            OrbitCamera camera;
            camera.orthographic = turn % 5 == 0;
            camera.azimuth_rad = turn * 0.9;
            camera.elevation_rad = turn * 0.11 - 1.3;
            frameCamera(camera, frame, aspect);
            glm::dvec2 low(9.0);
            glm::dvec2 high(-9.0);
            for (const glm::dvec3& vertex : vertices) {
                const glm::dvec3 ndc = project(camera, aspect, vertex);
                EXPECT_LT(std::abs(ndc.z), 1.0);
                low = glm::min(low, glm::dvec2(ndc));
                high = glm::max(high, glm::dvec2(ndc));
            }
            const glm::dvec2 share = (high - low) * 0.5;
            EXPECT_NEAR(std::max(share.x, share.y), 0.88, 0.03) << "turn " << turn;
            EXPECT_NEAR(low.x, -high.x, 0.02) << "turn " << turn;
            EXPECT_NEAR(low.y, -high.y, 0.02) << "turn " << turn;
        }
}

TEST(OrbitCamera, FramingLeavesOutVerticesBeyondTheBounds) {
    Bounds bounds = boxBounds({-2, 0, -3}, {4, 2, 2});
    for (const glm::dvec3& point : framePoints(*tripods(), bounds).points)
        EXPECT_LE(point.y, 2.0 + 1e-3);
}

TEST(OrbitCamera, FramingLooksPastStrayLinesUnlessThereIsNothingElse) {
    auto lines = std::make_shared<Geometry>();
    lines->positions = {{90, 0, 0}, {91, 0, 0}};
    auto scene = std::make_shared<Scene>(*tripods());
    scene->submeshes.push_back({"line", {{PrimitiveMode::Lines, lines}}});
    scene->instances.emplace_back();
    scene->instances.back().submesh = 1;
    for (const glm::dvec3& point : framePoints(*scene).points)
        EXPECT_LT(point.x, 10.0);
    scene->instances.erase(scene->instances.begin(), scene->instances.begin() + 2);
    EXPECT_EQ(framePoints(*scene).points.size(), 200u);
}

TEST(OrbitCamera, FramingNothingOrAPointStillLooksSomewhere) {
    OrbitCamera camera;
    frameCamera(camera, FramePoints{}, 1.5);
    EXPECT_GT(camera.distance, 1.0);
    frameCamera(camera, boxBounds({7, 7, 7}, {7, 7, 7}), 1.5);
    EXPECT_GT(camera.distance, 0.0);
    EXPECT_TRUE(std::isfinite(camera.distance));
    EXPECT_NEAR(glm::length(camera.target - glm::dvec3(7.0)), 0.0, 1e-6);
}

TEST(OrbitCamera, PanKeepsThePointUnderTheMouse) {
    OrbitCamera camera;
    frameCamera(camera, boxBounds({-1, -1, -1}, {1, 1, 1}), 1.5);
    const glm::dvec3 grabbed = camera.target;
    panCamera(camera, 0.25, -0.125);
    const glm::dvec3 ndc = project(camera, 1.5, grabbed);
    EXPECT_NEAR(ndc.x, 0.5 / 1.5, 1e-9);
    EXPECT_NEAR(ndc.y, -0.25, 1e-9);
}

TEST(OrbitCamera, FrontViewShowsXToTheRightAndYUp) {
    OrbitCamera camera;
    frameCamera(camera, boxBounds({-1, -1, -1}, {1, 1, 1}), 1.0);
    setAxisView(camera, AxisView::Front);
    EXPECT_GT(project(camera, 1.0, {0.5, 0, 0}).x, 0.1);
    EXPECT_GT(project(camera, 1.0, {0, 0.5, 0}).y, 0.1);
    EXPECT_LT(project(camera, 1.0, {0, 0, 0.5}).z, project(camera, 1.0, {0, 0, -0.5}).z);
}

TEST(OrbitCamera, RayGoesThroughThePointItWasAskedFor) {
    OrbitCamera camera;
    frameCamera(camera, boxBounds({-3, 1, -1}, {1, 2, 5}), 1.6);
    const glm::dvec3 point(-1.0, 1.5, 2.5);
    const glm::dvec3 ndc = project(camera, 1.6, point);
    const Ray ray = cameraRay(camera, 1.6, {ndc.x * 0.5 + 0.5, 0.5 - ndc.y * 0.5});
    EXPECT_NEAR(glm::length(glm::cross(point - ray.origin, ray.direction)), 0.0, 1e-9);
}

TEST(OrbitCamera, FileCameraKeepsItsPlaceDirectionAndRoll) {
    for (const double elevation : {-1.2, 0.0, 0.7, std::numbers::pi / 2.0}) {
        OrbitCamera wanted;
        wanted.target = {1.0, 2.0, 3.0};
        wanted.distance = 6.0;
        wanted.azimuth_rad = 2.1;
        wanted.elevation_rad = elevation;
        wanted.roll_rad = 0.4;
        Camera camera;
        camera.world = glm::inverse(viewMatrix(wanted));
        const OrbitCamera found = cameraFromScene(camera, boxBounds({0, 1, 2}, {2, 3, 4}));
        const glm::dmat4 difference = viewMatrix(found) - viewMatrix(wanted);
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(glm::length(difference[c]), 0.0, 1e-6) << elevation;
    }
}

TEST(OrbitCamera, EmptyBoundsStillGiveAFiniteView) {
    OrbitCamera camera;
    frameCamera(camera, Bounds{}, 1.0);
    EXPECT_TRUE(std::isfinite(project(camera, 1.0, {0, 0, 0}).z));
    EXPECT_GT(camera.distance, 0.0);
}

} // namespace
} // namespace lodestone
