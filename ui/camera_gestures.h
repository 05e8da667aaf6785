#pragma once
#include "app/view_state.h"

#include <optional>

namespace lodestone::ui {

struct GestureView {
    float shorter_side = 1.0f; // of the picture, in window units
    double fov_rad = 0.6;      // the angle that it spans
    Navigation navigation = Navigation::Lodestone;
};

// What the mouse does to the camera over the last ImGui item, a picture. nullopt: nothing.
// Lodestone: left or middle drag orbits, right or Shift+middle drag pans. Blender: middle drag
// orbits, with Shift it pans, with Ctrl it zooms. Maya: with Alt, left drag orbits, middle drag
// pans, right drag zooms. Everywhere Alt+left orbits and the wheel zooms.
std::optional<CameraState> cameraGesture(const CameraState& camera, const GestureView& view);

// What a left drag over the last ImGui item does to the light instead. nullopt: nothing.
std::optional<DisplayOptions> lightGesture(const DisplayOptions& view);

enum class AxisSide : std::uint8_t { Front, Right, Top };

CameraState lookFrom(CameraState camera, AxisSide side);
CameraState zoomed(CameraState camera, double factor); // factor > 0 times the distance

} // namespace lodestone::ui
