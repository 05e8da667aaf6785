#pragma once
// Pixels of an image, for what draws or measures it; an export passes on the encoded bytes.
#include "scene/scene.h"

namespace lodestone {

// RGBA, 8 bits a channel, top row first.
struct DecodedImage {
    std::unique_ptr<unsigned char, void (*)(void*)> rgba{nullptr, nullptr}; // null: see fault
    int width = 0;
    int height = 0;
    std::string fault; // what is wrong with the image; empty: decoded
};

// Decodes PNG and JPEG (and whatever else stb_image knows) and WebP, at most 2^27 pixels. Not KTX2:
// no library for it is packaged.
// max_size_px: of a side. Any thread.
DecodedImage decodeImage(const Image& image, int max_size_px);

// Width and height as the image's header has them, of those that decodeImage() knows; else 0. Any
// thread.
glm::ivec2 imageSize(const Image& image);

// "image 3 'bark'": how messages name an image of a scene. index in range.
std::string imageLabel(const Scene& scene, std::uint32_t index);

} // namespace lodestone
