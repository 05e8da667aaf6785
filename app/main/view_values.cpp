#include "app/main/view_values.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lodestone {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

} // namespace

Shading shadingFor(ShadingMode mode) {
    switch (mode) {
    case ShadingMode::Lit:
        return Shading::Lit;
    case ShadingMode::Clay:
        return Shading::Clay;
    case ShadingMode::Normals:
        return Shading::Normals;
    case ShadingMode::Flat:
        return Shading::Flat;
    case ShadingMode::UvChecker:
        return Shading::UvChecker;
    case ShadingMode::Submesh:
        return Shading::BySubmesh;
    case ShadingMode::Instance:
        return Shading::ByInstance;
    }
    return Shading::Lit;
}

OrbitCamera orbitCamera(const CameraState& state, const Bounds& bounds, double aspect) {
    OrbitCamera camera;
    camera.target = state.target;
    camera.distance = state.distance;
    camera.azimuth_rad = state.azimuth_deg * kRadiansPerDegree;
    camera.elevation_rad = state.elevation_deg * kRadiansPerDegree;
    camera.orthographic = state.orthographic;
    camera.yfov_rad = 2.0 * std::atan(std::tan(kVerticalFovRad * 0.5) / std::min(1.0, aspect));
    if (!bounds.empty) {
        camera.scene_center = bounds.center();
        camera.scene_radius = bounds.diagonal() * 0.5;
    }
    return camera;
}

ViewOptions viewOptions(const DisplayOptions& display) {
    ViewOptions options;
    options.shading = shadingFor(display.shading);
    options.wireframe = display.wireframe;
    options.background = Background::Solid;
    options.light_azimuth_rad = static_cast<float>(-display.light_azimuth_deg * kRadiansPerDegree);
    options.light_elevation_rad =
        static_cast<float>(display.light_elevation_deg * kRadiansPerDegree);
    return options;
}

} // namespace lodestone
