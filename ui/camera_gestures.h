#pragma once
#include "app/view_state.h"

#include <optional>

namespace lodestone::ui {

// What the mouse does to the camera over the last ImGui item, a picture: left or middle drag
// orbits, right or Shift+middle drag pans, the wheel zooms. nullopt: nothing.
// shorter_side: of the picture, in window units; fov_rad: the angle that it spans.
std::optional<CameraState>
cameraGesture(const CameraState& camera, float shorter_side, double fov_rad);

// What a left drag over the last ImGui item does to the light instead. nullopt: nothing.
std::optional<DisplayOptions> lightGesture(const DisplayOptions& view);

enum class AxisSide : std::uint8_t { Front, Right, Top };

CameraState lookFrom(CameraState camera, AxisSide side);
CameraState zoomed(CameraState camera, double factor); // factor > 0 times the distance

} // namespace lodestone::ui
