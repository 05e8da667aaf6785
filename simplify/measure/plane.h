#pragma once
// One channel of a picture and the separable filters that the image measures are made of.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone {

struct Plane {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> values; // [width * height], rows from the top

    Plane() = default;

    Plane(std::uint32_t width_px, std::uint32_t height_px)
        : width(width_px), height(height_px), values(std::size_t{width_px} * height_px) {}

    std::span<float> row(std::uint32_t y) {
        return {values.data() + std::size_t{y} * width, width};
    }

    std::span<const float> row(std::uint32_t y) const {
        return {values.data() + std::size_t{y} * width, width};
    }
};

using Kernel = std::vector<float>; // odd length, the middle weight belongs to the pixel itself

// exp(-x^2 / (2 sigma^2)) for x = -radius..radius, summing up to 1. sigma_px > 0.
Kernel gaussianKernel(double sigma_px, int radius_px);

// Weighted sums along x or y; what lies outside repeats the border. Parallel over rows; the same
// for any number of threads.
Plane filteredAlongX(const Plane& plane, const Kernel& kernel);
Plane filteredAlongY(const Plane& plane, const Kernel& kernel);

} // namespace lodestone
