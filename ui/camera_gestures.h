#pragma once
#include "app/view_state.h"

#include <optional>

namespace lodestone::ui {

// What the mouse does to the camera over the last ImGui item, a picture view_height high: left or
// middle drag orbits, right or Shift+middle drag pans, the wheel zooms. nullopt: nothing.
std::optional<CameraState>
cameraGesture(const CameraState& camera, float view_height, double yfov_rad);

enum class AxisSide : std::uint8_t { Front, Right, Top };

CameraState lookFrom(CameraState camera, AxisSide side);
CameraState zoomed(CameraState camera, double factor); // factor > 0 times the distance

} // namespace lodestone::ui
