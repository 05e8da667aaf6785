#pragma once
#include "scene/scene.h"

#include <memory>
#include <span>
#include <stb_image_write.h>

namespace lodestone {

// An image of a scene as PNG. rgb: [3 * width * height], rows from the top.
inline Image pngImage(std::string name, int width, int height, std::span<const std::uint8_t> rgb) {
    const auto bytes = std::make_shared<std::vector<std::byte>>();
    const auto append = [](void* to, void* data, int size) {
        const auto* begin = static_cast<const std::byte*>(data);
        auto& all = *static_cast<std::vector<std::byte>*>(to);
        all.insert(all.end(), begin, begin + size);
    };
    stbi_write_png_to_func(append, bytes.get(), width, height, 3, rgb.data(), 0);
    return {std::move(name), "image/png", {}, bytes};
}

} // namespace lodestone
