#pragma once
// The document's view in render/'s terms. One of the files beside main.cpp that know every room.
#include "app/view_state.h"
#include "render/view.h"

namespace lodestone {

Shading shadingFor(ShadingMode mode);

// aspect: of a view. The shorter side of the picture spans kVerticalFovRad, so that tall pictures
// cut nothing off.
OrbitCamera orbitCamera(const CameraState& state, const Bounds& bounds, double aspect);

ViewOptions viewOptions(const DisplayOptions& display);

} // namespace lodestone
