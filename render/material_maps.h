#pragma once
// Inside render/ only: which images materials use, and how.
#include "render/gpu_texture.h"
#include "render/renderer_state.h"

#include <array>

namespace lodestone {

struct MapSlot {
    const TextureRef* reference;
    std::uint32_t feature;
    ColorSpace color_space;
};

// In the order of the map features; units 0..4.
std::array<MapSlot, kMaterialMaps> mapSlots(const Material& material);

// The scene's materials and, last, glTF's default.
std::vector<Material> drawnMaterials(const Scene& scene);

} // namespace lodestone
