#include "app/main/view_values.h"

#include "app/scene_texels.h"

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
    case ShadingMode::Matcap:
        return Shading::Matcap;
    case ShadingMode::LodState:
        return Shading::ByLodState;
    case ShadingMode::Texels:
        return Shading::ByTexels;
    }
    return Shading::Lit;
}

namespace {

glm::vec3 backdropColor(Backdrop backdrop) {
    switch (backdrop) {
    case Backdrop::Grey:
        return glm::vec3(0.46f);
    case Backdrop::Light:
        return {0.87f, 0.88f, 0.90f};
    case Backdrop::Gradient:
        return {0.17f, 0.19f, 0.22f};
    case Backdrop::Dark:
        break;
    }
    return ViewOptions().background_srgb;
}

} // namespace

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

std::array<glm::vec3, 9> valueColors(ColorMap map) {
    std::array<glm::vec3, 9> colors{};
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (int c = 0; c < 3; ++c)
            colors[i][c] =
                static_cast<float>(mapColors(map)[i][static_cast<std::size_t>(c)]) / 255.0f;
    return colors;
}

namespace {

void scaleTexels(ViewOptions& options, double texels_full) {
    options.value_full = static_cast<float>(texels_full);
    options.value_span = static_cast<float>(kTexelSpan);
}

} // namespace

ViewOptions shadedOptions(ShadingMode mode, const Scene& scene) {
    ViewOptions options;
    options.shading = shadingFor(mode);
    options.value_colors = valueColors(ColorMap::Viridis);
    if (mode == ShadingMode::Texels)
        scaleTexels(options, texelsFull(texelsPerUnit(scene)));
    return options;
}

ViewOptions viewOptions(const DisplayOptions& display, const FullValues& full) {
    ViewOptions options;
    options.shading = shadingFor(display.shading);
    options.wireframe = display.wireframe;
    options.background =
        display.backdrop == Backdrop::Gradient ? Background::Gradient : Background::Solid;
    options.background_srgb = backdropColor(display.backdrop);
    options.grid = display.grid;
    options.shininess = static_cast<float>(display.shininess);
    options.moment = display.moment;
    options.value_colors = valueColors(display.colors);
    if (display.compare == CompareMode::HeatMap) {
        options.shading = Shading::ByValue;
        options.value_full = static_cast<float>(full.error);
    } else if (display.shading == ShadingMode::Texels) {
        scaleTexels(options, full.texels);
    }
    options.light_azimuth_rad = static_cast<float>(-display.light_azimuth_deg * kRadiansPerDegree);
    options.light_elevation_rad =
        static_cast<float>(display.light_elevation_deg * kRadiansPerDegree);
    return options;
}

} // namespace lodestone
