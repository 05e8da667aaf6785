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

// What last colours stand for.
struct FullValues {
    double error = 1.0;  // of a heat map
    double texels = 1.0; // of ShadingMode::Texels
};

ViewOptions viewOptions(const DisplayOptions& display, const FullValues& full);

// Options that show a scene, or LODs of it, in a mode.
ViewOptions shadedOptions(ShadingMode mode, const Scene& scene);

} // namespace lodestone
