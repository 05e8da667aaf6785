#pragma once
// Inside render/ only: the scene's images as GL textures.
#include "render/gl_object.h"
#include "scene/scene.h"

#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace lodestone {

enum class ColorSpace : std::uint8_t { Srgb, Linear };

struct TextureWish {
    std::uint32_t image = kNone;
    ColorSpace color_space = ColorSpace::Srgb;

    bool operator<(const TextureWish& other) const {
        return std::tie(image, color_space) < std::tie(other.image, other.color_space);
    }
};

struct GpuTexture {
    GlTexture texture; // empty: could not be decoded
    std::uint64_t bytes = 0;
};

// Decodes PNG and JPEG (and whatever else stb_image knows) in parallel, uploads with mipmaps.
// Returns textures[i] for wishes[i]; notes name what could not be shown. GL on the calling thread.
std::vector<GpuTexture> uploadTextures(const Scene& scene,
                                       const std::vector<TextureWish>& wishes,
                                       int max_size_px,
                                       std::vector<std::string>& notes);

} // namespace lodestone
