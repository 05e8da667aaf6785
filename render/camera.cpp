#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace lodestone {

namespace {

constexpr double kMaxElevation = 89.9 * std::numbers::pi / 180.0;
constexpr double kFrameFill = 0.88; // share of the view that what is framed spans

struct Axes {
    glm::dvec3 right;
    glm::dvec3 up;
    glm::dvec3 back; // from the target to the camera
};

Axes cameraAxes(const OrbitCamera& camera) {
    const double ce = std::cos(camera.elevation_rad);
    const double se = std::sin(camera.elevation_rad);
    const double ca = std::cos(camera.azimuth_rad);
    const double sa = std::sin(camera.azimuth_rad);
    const glm::dvec3 back(ce * sa, se, ce * ca);
    const glm::dvec3 level_right(ca, 0.0, -sa);
    const glm::dvec3 level_up = glm::cross(back, level_right);
    const double cr = std::cos(camera.roll_rad);
    const double sr = std::sin(camera.roll_rad);
    return {level_right * cr + level_up * sr, level_up * cr - level_right * sr, back};
}

struct Sphere {
    glm::dvec3 center{0.0};
    double radius = 1.0;
};

Sphere sphereAround(const Bounds& bounds) {
    if (bounds.empty)
        return {};
    const double radius = bounds.diagonal() * 0.5;
    if (!std::isfinite(radius))
        return {};
    // A single point still has a size to be looked at.
    const double smallest = 1e-9 * std::max(1.0, glm::length(bounds.center()));
    return {bounds.center(), radius > smallest ? radius : std::max(smallest, 1e-3)};
}

double halfHeightAtTarget(const OrbitCamera& camera) {
    return camera.distance * std::tan(camera.yfov_rad * 0.5);
}

// Points seen from the origin along the camera's axes: x right, y up, z towards the camera.
std::vector<glm::dvec3>
alongAxes(std::span<const glm::dvec3> points, const glm::dvec3& origin, const Axes& axes) {
    std::vector<glm::dvec3> seen;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 from = point - origin;
        seen.emplace_back(
            glm::dot(from, axes.right), glm::dot(from, axes.up), glm::dot(from, axes.back));
    }
    return seen;
}

struct Span {
    double low = 0.0;
    double high = 0.0;
};

// Where the points are in the picture along one axis, in tangents of the viewing angle (in lengths
// without perspective), for an eye at `eye`.
Span pictureSpan(std::span<const glm::dvec3> points,
                 const glm::dvec3& eye,
                 int axis,
                 bool orthographic) {
    Span span{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const glm::dvec3& point : points) {
        const double depth = orthographic ? 1.0 : eye.z - point.z;
        const double at = (point[axis] - eye[axis]) / depth;
        span = {std::min(span.low, at), std::max(span.high, at)};
    }
    return span;
}

// Nearest eye that sees all points within the tangents (x, y), and the middle of the picture.
// Each point bounds the eye by two planes an axis: the highest crossing is the answer.
glm::dvec3 nearestEye(std::span<const glm::dvec3> points, const glm::dvec2& tangent) {
    double front = -std::numeric_limits<double>::infinity();
    glm::dvec3 eye(0.0, 0.0, front);
    for (int axis = 0; axis < 2; ++axis) {
        double right = front;
        double left = front;
        for (const glm::dvec3& point : points) {
            right = std::max(right, point[axis] + tangent[axis] * point.z);
            left = std::max(left, tangent[axis] * point.z - point[axis]);
        }
        eye[axis] = (right - left) * 0.5;
        eye.z = std::max(eye.z, (right + left) * 0.5 / tangent[axis]);
    }
    return eye;
}

// The point of view that fits the points, relative to the origin of their coordinates.
glm::dvec3 fittingEye(std::span<const glm::dvec3> points,
                      const OrbitCamera& camera,
                      const glm::dvec2& tangent,
                      double radius) {
    glm::dvec3 eye = nearestEye(points, tangent);
    double front = 0.0;
    for (const glm::dvec3& point : points)
        front = std::max(front, point.z);
    eye.z = std::max(eye.z, front + radius * 0.05); // things seen edge-on
    if (camera.orthographic) {
        glm::dvec2 half(0.0);
        for (int axis = 0; axis < 2; ++axis) {
            const Span span = pictureSpan(points, {0.0, 0.0, 0.0}, axis, true);
            eye[axis] = (span.low + span.high) * 0.5;
            half[axis] = (span.high - span.low) * 0.5;
        }
        eye.z = std::max({half.x / tangent.x, half.y / tangent.y, radius * 0.05});
        return eye;
    }
    // The axis that has room left: the picture's middle, not the box's.
    constexpr int kCentringSteps = 4;
    for (int step = 0; step < kCentringSteps; ++step)
        for (int axis = 0; axis < 2; ++axis) {
            const Span span = pictureSpan(points, eye, axis, false);
            eye[axis] += (span.low + span.high) * 0.5 * eye.z;
        }
    return eye;
}

void aimAt(OrbitCamera& camera, const FramePoints& frame, double aspect) {
    const Sphere sphere = sphereAround(frame.bounds);
    camera.target = sphere.center;
    camera.distance = sphere.radius / std::sin(camera.yfov_rad * 0.5);
    if (frame.points.empty() || !std::isfinite(frame.bounds.diagonal()) || !(aspect > 0.0))
        return;
    const Axes axes = cameraAxes(camera);
    const std::vector<glm::dvec3> points = alongAxes(frame.points, sphere.center, axes);
    const double tangent = std::tan(camera.yfov_rad * 0.5) * kFrameFill;
    const glm::dvec3 eye = fittingEye(points, camera, {tangent * aspect, tangent}, sphere.radius);
    camera.target += axes.right * eye.x + axes.up * eye.y;
    camera.distance = eye.z;
}

} // namespace

void frameCamera(OrbitCamera& camera, const FramePoints& frame, double aspect) {
    const Sphere sphere = sphereAround(frame.bounds);
    camera.scene_center = sphere.center;
    camera.scene_radius = sphere.radius;
    aimAt(camera, frame, aspect);
}

void frameCamera(OrbitCamera& camera, const Bounds& bounds, double aspect) {
    frameCamera(camera, framePoints(bounds), aspect);
}

void frameSelection(OrbitCamera& camera, const Bounds& bounds, double aspect) {
    if (!bounds.empty)
        aimAt(camera, framePoints(bounds), aspect);
}

void orbitCamera(OrbitCamera& camera, double azimuth_rad, double elevation_rad) {
    camera.azimuth_rad = std::remainder(camera.azimuth_rad + azimuth_rad, 2.0 * std::numbers::pi);
    camera.elevation_rad =
        std::clamp(camera.elevation_rad + elevation_rad, -kMaxElevation, kMaxElevation);
}

void panCamera(OrbitCamera& camera, double shift_x, double shift_y) {
    const Axes axes = cameraAxes(camera);
    const double height = 2.0 * halfHeightAtTarget(camera);
    camera.target -= (axes.right * shift_x + axes.up * shift_y) * height;
}

void zoomCamera(OrbitCamera& camera, double factor) {
    if (!(factor > 0.0))
        return;
    camera.distance =
        std::clamp(camera.distance * factor, camera.scene_radius * 1e-5, camera.scene_radius * 1e3);
}

void dollyCamera(OrbitCamera& camera, double fraction) {
    camera.target -= cameraAxes(camera).back * (camera.distance * fraction);
}

void setAxisView(OrbitCamera& camera, AxisView view) {
    constexpr double kHalf = std::numbers::pi * 0.5;
    camera.roll_rad = 0.0;
    camera.elevation_rad = 0.0;
    switch (view) {
    case AxisView::Front:
        camera.azimuth_rad = 0.0;
        break;
    case AxisView::Back:
        camera.azimuth_rad = 2.0 * kHalf;
        break;
    case AxisView::Right:
        camera.azimuth_rad = kHalf;
        break;
    case AxisView::Left:
        camera.azimuth_rad = -kHalf;
        break;
    case AxisView::Top:
        camera.azimuth_rad = 0.0;
        camera.elevation_rad = kHalf;
        break;
    case AxisView::Bottom:
        camera.azimuth_rad = 0.0;
        camera.elevation_rad = -kHalf;
        break;
    }
}

OrbitCamera cameraFromScene(const Camera& camera, const Bounds& bounds) {
    OrbitCamera orbit;
    const Sphere sphere = sphereAround(bounds);
    orbit.scene_center = sphere.center;
    orbit.scene_radius = sphere.radius;
    const glm::dvec3 position(camera.world[3]);
    const auto direction = [](glm::dvec4 column, glm::dvec3 otherwise) {
        const double length = glm::length(glm::dvec3(column));
        return length > 0.0 && std::isfinite(length) ? glm::dvec3(column) / length : otherwise;
    };
    const glm::dvec3 back = direction(camera.world[2], {0.0, 0.0, 1.0});
    const glm::dvec3 up = direction(camera.world[1], {0.0, 1.0, 0.0});
    orbit.elevation_rad = std::asin(std::clamp(back.y, -1.0, 1.0));
    orbit.azimuth_rad = std::abs(back.y) < 0.999999 ? std::atan2(back.x, back.z)
                                                    : std::atan2(-up.x * back.y, -up.z * back.y);
    const Axes level = cameraAxes(orbit);
    orbit.roll_rad = std::atan2(-glm::dot(up, level.right), glm::dot(up, level.up));
    const double along = glm::dot(position - sphere.center, back);
    orbit.distance = std::max(along, sphere.radius * 0.05);
    orbit.target = position - back * orbit.distance;
    orbit.orthographic = !camera.perspective;
    orbit.yfov_rad = camera.perspective && camera.yfov_rad > 0.0 && camera.yfov_rad < 3.1
                         ? camera.yfov_rad
                         : 2.0 * std::atan(std::abs(camera.ymag) / orbit.distance);
    return orbit;
}

glm::dvec3 cameraPosition(const OrbitCamera& camera) {
    return camera.target + cameraAxes(camera).back * camera.distance;
}

glm::dmat4 viewMatrix(const OrbitCamera& camera) {
    const Axes axes = cameraAxes(camera);
    const glm::dvec3 eye = cameraPosition(camera);
    glm::dmat4 view(1.0);
    for (int c = 0; c < 3; ++c) {
        view[c][0] = axes.right[c];
        view[c][1] = axes.up[c];
        view[c][2] = axes.back[c];
    }
    view[3] = glm::dvec4(
        -glm::dot(axes.right, eye), -glm::dot(axes.up, eye), -glm::dot(axes.back, eye), 1.0);
    return view;
}

ClipPlanes clipPlanes(const OrbitCamera& camera) {
    const Axes axes = cameraAxes(camera);
    const double depth = glm::dot(cameraPosition(camera) - camera.scene_center, axes.back);
    const double radius = camera.scene_radius * 1.01;
    ClipPlanes planes;
    if (camera.orthographic) {
        planes.zfar = std::max(depth + radius, camera.scene_radius * 1e-3);
        planes.znear = std::min(depth - radius, planes.zfar - radius * 1e-3);
        return planes;
    }
    // 24 bits of depth carry four decades of range well.
    planes.zfar = std::max(depth + radius, camera.distance * 2.0);
    planes.znear = std::max(depth - radius, planes.zfar * 1e-4);
    planes.znear = std::min(planes.znear, camera.distance * 0.5);
    return planes;
}

glm::dmat4 projectionMatrix(const OrbitCamera& camera, double aspect) {
    const ClipPlanes planes = clipPlanes(camera);
    if (!camera.orthographic)
        return glm::perspective(camera.yfov_rad, aspect, planes.znear, planes.zfar);
    const double half = halfHeightAtTarget(camera);
    return glm::ortho(-half * aspect, half * aspect, -half, half, planes.znear, planes.zfar);
}

Ray cameraRay(const OrbitCamera& camera, double aspect, glm::dvec2 point) {
    const Axes axes = cameraAxes(camera);
    const double half = halfHeightAtTarget(camera);
    const glm::dvec3 shift = axes.right * ((point.x * 2.0 - 1.0) * half * aspect) +
                             axes.up * ((1.0 - point.y * 2.0) * half);
    const glm::dvec3 eye = cameraPosition(camera);
    if (camera.orthographic)
        return {eye + shift, -axes.back};
    return {eye, glm::normalize(camera.target + shift - eye)};
}

double pixelSize(const OrbitCamera& camera, double view_height_px) {
    return 2.0 * halfHeightAtTarget(camera) / std::max(view_height_px, 1.0);
}

} // namespace lodestone
