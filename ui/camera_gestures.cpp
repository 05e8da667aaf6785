#include "ui/camera_gestures.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>
#include <numbers>

namespace lodestone::ui {

namespace {

constexpr double kDegreesPerUnit = 0.4; // of mouse travel
constexpr double kZoomPerNotch = 0.88;
constexpr double kSteepestDegrees = 89.9;

double radians(double degrees) {
    return degrees * std::numbers::pi / 180.0;
}

CameraState panned(CameraState camera, double right_units, double up_units, double unit_size) {
    const double azimuth = radians(camera.azimuth_deg);
    const double elevation = radians(camera.elevation_deg);
    const glm::dvec3 right{std::cos(azimuth), 0.0, -std::sin(azimuth)};
    const glm::dvec3 up{-std::sin(azimuth) * std::sin(elevation),
                        std::cos(elevation),
                        -std::cos(azimuth) * std::sin(elevation)};
    camera.target += (right * right_units + up * up_units) * unit_size;
    return camera;
}

CameraState orbited(CameraState camera, double right_units, double down_units) {
    camera.azimuth_deg = std::remainder(camera.azimuth_deg - right_units * kDegreesPerUnit, 360.0);
    camera.elevation_deg = std::clamp(
        camera.elevation_deg + down_units * kDegreesPerUnit, -kSteepestDegrees, kSteepestDegrees);
    return camera;
}

} // namespace

CameraState zoomed(CameraState camera, double factor) {
    camera.distance *= factor;
    return camera;
}

CameraState lookFrom(CameraState camera, AxisSide side) {
    camera.azimuth_deg = side == AxisSide::Right ? 90.0 : 0.0;
    camera.elevation_deg = side == AxisSide::Top ? kSteepestDegrees : 0.0;
    return camera;
}

std::optional<DisplayOptions> lightGesture(const DisplayOptions& view) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool moves = io.MouseDelta.x != 0.0f || io.MouseDelta.y != 0.0f;
    if (!moves || !ImGui::IsItemActive() || !ImGui::IsMouseDown(ImGuiMouseButton_Left))
        return std::nullopt;
    DisplayOptions lit = view;
    lit.light_azimuth_deg =
        std::remainder(view.light_azimuth_deg - static_cast<double>(io.MouseDelta.x), 360.0);
    lit.light_elevation_deg =
        std::clamp(view.light_elevation_deg - static_cast<double>(io.MouseDelta.y),
                   -kSteepestDegrees,
                   kSteepestDegrees);
    return lit;
}

namespace {

enum class Gesture : std::uint8_t { None, Orbit, Pan, Zoom };

Gesture gestureOf(Navigation navigation, const ImGuiIO& io) {
    const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    const bool middle = ImGui::IsMouseDown(ImGuiMouseButton_Middle);
    const bool right = ImGui::IsMouseDown(ImGuiMouseButton_Right);
    if (left && io.KeyAlt)
        return Gesture::Orbit;
    switch (navigation) {
    case Navigation::Blender:
        if (!middle)
            return Gesture::None;
        return io.KeyShift ? Gesture::Pan : io.KeyCtrl ? Gesture::Zoom : Gesture::Orbit;
    case Navigation::Maya:
        if (!io.KeyAlt)
            return Gesture::None;
        return middle ? Gesture::Pan : right ? Gesture::Zoom : Gesture::None;
    case Navigation::Lodestone:
        break;
    }
    if (right || (middle && io.KeyShift))
        return Gesture::Pan;
    return left || middle ? Gesture::Orbit : Gesture::None;
}

} // namespace

std::optional<CameraState> cameraGesture(const CameraState& camera, const GestureView& view) {
    constexpr double kZoomPerUnit = 0.006; // of mouse travel
    const ImGuiIO& io = ImGui::GetIO();
    CameraState moved = camera;
    if (ImGui::IsItemActive()) {
        const double unit_size = 2.0 * camera.distance * std::tan(view.fov_rad * 0.5) /
                                 static_cast<double>(std::max(1.0f, view.shorter_side));
        const auto right = static_cast<double>(io.MouseDelta.x);
        const auto down = static_cast<double>(io.MouseDelta.y);
        switch (gestureOf(view.navigation, io)) {
        case Gesture::Orbit:
            moved = orbited(moved, right, down);
            break;
        case Gesture::Pan:
            moved = panned(moved, -right, down, unit_size);
            break;
        case Gesture::Zoom:
            moved = zoomed(moved, std::exp((down - right) * kZoomPerUnit));
            break;
        case Gesture::None:
            break;
        }
    }
    if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f)
        moved = zoomed(moved, std::pow(kZoomPerNotch, static_cast<double>(io.MouseWheel)));
    if (moved == camera)
        return std::nullopt;
    return moved;
}

} // namespace lodestone::ui
