#pragma once
// Colours for numbers, even to the eye and for the colour-blind.
#include <array>
#include <cstdint>

namespace lodestone {

// Viridis: Smith and van der Walt 2015. Cividis: Nunez, Anderton, Renslow 2018.
enum class ColorMap : std::uint8_t { Viridis, Cividis };

using MapColor = std::array<std::uint8_t, 3>; // sRGB

// Evenly spaced from the smallest to the largest number; straight lines between them in sRGB.
const std::array<MapColor, 9>& mapColors(ColorMap map);

// share: clamped to 0..1.
MapColor mapColorAt(ColorMap map, double share);

} // namespace lodestone
