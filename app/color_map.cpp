#include "app/color_map.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

constexpr std::array<MapColor, 9> kViridis = {{{0x44, 0x01, 0x54},
                                               {0x47, 0x2d, 0x7b},
                                               {0x3b, 0x52, 0x8b},
                                               {0x2c, 0x72, 0x8e},
                                               {0x21, 0x91, 0x8c},
                                               {0x28, 0xae, 0x80},
                                               {0x5e, 0xc9, 0x62},
                                               {0xad, 0xdc, 0x30},
                                               {0xfd, 0xe7, 0x25}}};
constexpr std::array<MapColor, 9> kCividis = {{{0x00, 0x22, 0x4e},
                                               {0x12, 0x35, 0x70},
                                               {0x3b, 0x49, 0x6c},
                                               {0x57, 0x5d, 0x6d},
                                               {0x70, 0x71, 0x73},
                                               {0x8a, 0x86, 0x78},
                                               {0xa5, 0x9c, 0x74},
                                               {0xc3, 0xb3, 0x69},
                                               {0xfe, 0xe8, 0x38}}};

} // namespace

const std::array<MapColor, 9>& mapColors(ColorMap map) {
    return map == ColorMap::Cividis ? kCividis : kViridis;
}

MapColor mapColorAt(ColorMap map, double share) {
    const std::array<MapColor, 9>& colors = mapColors(map);
    const double last = static_cast<double>(colors.size() - 1);
    const double place = std::clamp(share, 0.0, 1.0) * last;
    const auto lower = static_cast<std::size_t>(std::min(place, last - 1.0));
    const double between = place - static_cast<double>(lower);
    MapColor color{};
    for (std::size_t c = 0; c < color.size(); ++c)
        color[c] = static_cast<std::uint8_t>(
            std::lround(colors[lower][c] * (1.0 - between) + colors[lower + 1][c] * between));
    return color;
}

} // namespace lodestone
