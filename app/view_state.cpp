#include "app/view_state.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone {

namespace {

constexpr std::array<std::string_view, kShadingModes> kShadingNames = {
    "lit", "clay", "normals", "flat", "uv", "submesh", "instance", "matcap", "lod", "texels"};
constexpr std::array<std::string_view, 5> kCompareNames = {
    "grid", "split", "flicker", "heat map", "difference"};

} // namespace

std::string_view shadingName(ShadingMode shading) {
    return kShadingNames.at(static_cast<std::size_t>(shading));
}

std::optional<ShadingMode> shadingFromName(std::string_view name) {
    for (std::size_t index = 0; index < kShadingNames.size(); ++index)
        if (kShadingNames[index] == name)
            return static_cast<ShadingMode>(index);
    return std::nullopt;
}

std::string_view compareName(CompareMode compare) {
    return kCompareNames.at(static_cast<std::size_t>(compare));
}

CameraState framed(const CameraState& camera, const Bounds& bounds) {
    if (bounds.empty)
        return camera;
    CameraState result = camera;
    result.target = bounds.center();
    const double radius = std::max(bounds.diagonal() * 0.5, 1e-6);
    // The bounding sphere touches the view's upper and lower edge; the scene itself is smaller.
    constexpr double kSphereSlack = 0.85;
    result.distance = kSphereSlack * radius / std::sin(kVerticalFovRad * 0.5);
    return result;
}

} // namespace lodestone
