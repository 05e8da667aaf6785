#pragma once
// The document's view in render/'s terms. One of the files beside main.cpp that know every room.
#include "app/view_state.h"
#include "render/view.h"

namespace lodestone {

Shading shadingFor(ShadingMode mode);

// aspect: of a view. The shorter side of the picture spans kVerticalFovRad, so that tall pictures
// cut nothing off.
OrbitCamera orbitCamera(const CameraState& state, const Bounds& bounds, double aspect);

std::array<glm::vec3, 9> valueColors(ColorMap map);

// value_full: what the last colour of a heat map stands for.
ViewOptions viewOptions(const DisplayOptions& display, double value_full);

} // namespace lodestone
