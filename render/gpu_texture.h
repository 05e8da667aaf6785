#pragma once
// Inside render/ only: the scene's images as GL textures.
#include "render/gl_object.h"
#include "scene/decoded_image.h"

#include <cstdint>
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

// Decodes in parallel: images[i] for wishes[i]; a fault is a line about the image. Any thread; no
// GL.
std::vector<DecodedImage>
decodeImages(const Scene& scene, const std::vector<TextureWish>& wishes, int max_size_px);

// With mipmaps. Main thread; texture: GlTexture::create().
GpuTexture uploadTexture(GlTexture texture, const DecodedImage& image, ColorSpace color_space);

} // namespace lodestone
