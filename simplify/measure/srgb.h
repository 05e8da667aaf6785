#pragma once
// The transfer function of sRGB (IEC 61966-2-1).
#include <algorithm>
#include <cmath>

namespace lodestone {

// 0..1 to 0..1; what lies outside is clamped.
inline double srgbFromLinear(double value) {
    const double inside = std::clamp(value, 0.0, 1.0);
    return inside > 0.0031308 ? 1.055 * std::pow(inside, 1.0 / 2.4) - 0.055 : 12.92 * inside;
}

inline double linearFromSrgb(double value) {
    return value > 0.04045 ? std::pow((value + 0.055) / 1.055, 2.4) : value / 12.92;
}

} // namespace lodestone
