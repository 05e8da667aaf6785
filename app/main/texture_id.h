#pragma once
#include "render/gpu_scene.h"

#include <imgui.h>

namespace lodestone {

// What Dear ImGui calls a texture.
inline ImTextureID textureId(TextureHandle texture) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr)
    return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(texture));
}

} // namespace lodestone
