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
