#pragma once
// Orbit camera. Pure arithmetic in double, right-handed, y up, looks along -z; no GL.
#include "render/frame_points.h"
#include "scene/scene.h"

#include <glm/glm.hpp>

namespace lodestone {

struct OrbitCamera {
    glm::dvec3 target{0.0};      // what is orbited, world
    double distance = 5.0;       // from target, > 0
    double azimuth_rad = 0.6;    // 0: from +z; grows towards +x
    double elevation_rad = 0.35; // 0: level; pi/2: from above
    double roll_rad = 0.0;
    double yfov_rad = 0.6;     // full vertical angle, (0, pi)
    bool orthographic = false; // height shown = the perspective's at the target
    // The bounding sphere that near and far planes enclose; set by frameCamera.
    glm::dvec3 scene_center{0.0};
    double scene_radius = 1.0;

    bool operator==(const OrbitCamera&) const = default;
};

enum class AxisView : std::uint8_t { Front, Back, Right, Left, Top, Bottom };

// Keeps the direction; target and distance so that the points span 88 % of the view's tighter side
// at this aspect (width / height) and are in its middle; near and far planes enclose the bounds.
// No points: a unit sphere at the origin.
void frameCamera(OrbitCamera& camera, const FramePoints& frame, double aspect);
// The same for the corners of the box: looser, as the box is larger than what it encloses.
void frameCamera(OrbitCamera& camera, const Bounds& bounds, double aspect);
// As frameCamera, for a part of the scene: near and far planes keep enclosing the scene.
void frameSelection(OrbitCamera& camera, const Bounds& bounds, double aspect);

// Angles added; elevation is clamped to +-89.9 degrees.
void orbitCamera(OrbitCamera& camera, double azimuth_rad, double elevation_rad);
// Moves the target in the picture's plane; shift in fractions of the view's height, x right, y up:
// the point under the mouse stays under it.
void panCamera(OrbitCamera& camera, double shift_x, double shift_y);
// Distance multiplied by factor (> 0); never closer than 1e-5 of the scene, never beyond 1e3 of it.
void zoomCamera(OrbitCamera& camera, double factor);
// Moves camera and target along the view, in fractions of the distance.
void dollyCamera(OrbitCamera& camera, double fraction);
void setAxisView(OrbitCamera& camera, AxisView view);

// A camera of the file; it orbits the point in front of it that is nearest to the middle of bounds.
OrbitCamera cameraFromScene(const Camera& camera, const Bounds& bounds);

glm::dvec3 cameraPosition(const OrbitCamera& camera);
glm::dmat4 viewMatrix(const OrbitCamera& camera); // world to eye
// Clip space of OpenGL (z -1..1). aspect: width / height.
glm::dmat4 projectionMatrix(const OrbitCamera& camera, double aspect);

struct ClipPlanes {
    double znear = 0.1;
    double zfar = 10.0;
};

ClipPlanes clipPlanes(const OrbitCamera& camera);

struct Ray {
    glm::dvec3 origin{0.0};
    glm::dvec3 direction{0.0, 0.0, -1.0}; // unit length
};

// Through a point of the view: 0..1 from the left, 0..1 from the top.
Ray cameraRay(const OrbitCamera& camera, double aspect, glm::dvec2 point);

// World size of one pixel at the target.
double pixelSize(const OrbitCamera& camera, double view_height_px);

} // namespace lodestone
