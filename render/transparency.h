#pragma once
// Inside render/ only: the order in which transparent things are drawn.
#include "render/gpu_scene_state.h"
#include "render/view.h"

namespace lodestone {

struct BlendedInstance {
    const DrawItem* item = nullptr;
    std::uint32_t place = 0; // in the item's instance buffer
    double depth = 0.0;      // of its middle, along the view
};

// Materials blend in the shadings that show them; the others draw everything opaque.
bool isBlended(const DrawItem& item, const GpuSceneState& scene, Shading shading);

// Kept instances of all blended items in view, farthest first. Empty if there are none, or more
// than 4,096: each costs a draw call, so crowds are drawn item by item in the order of the file.
std::vector<BlendedInstance> backToFront(const View::Input& input);

} // namespace lodestone
