#pragma once
// What a transfer of textures is to give.
#include <array>
#include <cstdint>
#include <optional>

namespace lodestone {

enum class AtlasFormat : std::uint8_t {
    Auto, // JPEG where everything it is made from is, nothing is transparent and it is smaller
    Png,
    Jpeg, // where nothing is transparent
};

struct BakeOptions {
    std::uint32_t atlas_px = 1024; // side of every atlas, 256..8192
    bool merge_materials = false;  // one atlas for all materials that blend alike; else one each
    // Materials keep their textures where the texture coordinates that are left show the original
    // no worse than a new atlas, and with no more bytes of images.
    bool keep_better = false;
    // What texels hold that no triangle uses; else the mean of those that are used.
    std::optional<std::array<std::uint8_t, 3>> unused;
    AtlasFormat format = AtlasFormat::Auto;
    int jpeg_quality = 92; // 1..100; above 90 colours are not stored at half the resolution

    friend bool operator==(const BakeOptions&, const BakeOptions&) = default;
};

} // namespace lodestone
