#pragma once
// Pixels of an atlas as the bytes of an image file.
#include "scene/result.h"
#include "scene/scene.h"
#include "simplify/bake/bake_options.h"

#include <span>

namespace lodestone {

enum class Channels : std::uint8_t { Rgb = 3, Rgba = 4 };

struct AtlasPixels {
    std::span<const std::uint8_t> rgba; // [4 * size_px * size_px], top row first
    std::uint32_t size_px = 0;
    Channels channels = Channels::Rgb; // Rgba: alpha matters, never JPEG
    bool from_jpeg = false;            // all textures that it was made from were
};

// By its first bytes, whatever its file says.
bool isJpeg(const Image& image);

// As the options' format says. The same pixels and options give the same bytes.
// Errors: Failed (memory). Any thread.
Result<Image> encodedAtlas(std::string name, const AtlasPixels& pixels, const BakeOptions& options);

} // namespace lodestone
