#pragma once
// Pictures on the CPU side: what read-back returns, what is laid side by side and written as PNG.
#include "scene/result.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace lodestone {

using Rgba8 = std::array<std::uint8_t, 4>; // sRGB, straight alpha

// Rows top-down, no padding.
struct Pixels {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgba; // [4 * width * height]

    Pixels() = default;
    Pixels(std::uint32_t width_px, std::uint32_t height_px, Rgba8 fill);

    bool empty() const { return rgba.empty(); }

    Rgba8 at(std::uint32_t x, std::uint32_t y) const; // in range
    void set(std::uint32_t x, std::uint32_t y, Rgba8 color);
};

struct SheetCell {
    Pixels picture;
    std::string label; // one line below the picture; empty: none
};

struct SheetOptions {
    std::uint32_t columns = 0; // 0: all in one row
    std::uint32_t gap_px = 8;  // between cells and around them
    Rgba8 background{0x14, 0x17, 0x1b, 255};
    Rgba8 text{0xe8, 0xea, 0xed, 255};
    std::filesystem::path font; // TrueType file for the labels; empty: no labels drawn
    float font_size_px = 15.0f;
};

// Columns of a sheet that is about as wide as its pictures are: 1; 2; 3; 4 as 2 x 2; 6 as 3 x 2;
// 9 as 3 x 3; else as near to a square as full rows allow.
std::uint32_t sheetColumns(std::uint32_t pictures);

// Lays pictures out in rows, each centred in a cell as large as the largest picture.
// Errors: BadInput for a font that cannot be read; Usage for a sheet beyond 32,768 px a side.
Result<Pixels> composeSheet(std::span<const SheetCell> cells, const SheetOptions& options);

// Writes a PNG next to the path and renames it: an existing file is kept when writing fails.
Result<void> writePng(const std::filesystem::path& path, const Pixels& pixels);

} // namespace lodestone
