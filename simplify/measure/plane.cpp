#include "simplify/measure/plane.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

Kernel gaussianKernel(double sigma_px, int radius_px) {
    std::vector<double> weights;
    double sum = 0.0;
    for (int x = -radius_px; x <= radius_px; ++x) {
        weights.push_back(std::exp(-0.5 * x * x / (sigma_px * sigma_px)));
        sum += weights.back();
    }
    Kernel kernel;
    for (const double weight : weights)
        kernel.push_back(static_cast<float>(weight / sum));
    return kernel;
}

Plane filteredAlongX(const Plane& plane, const Kernel& kernel) {
    Plane result(plane.width, plane.height);
    const std::size_t radius = kernel.size() / 2;
    tbb::parallel_for(std::uint32_t{0}, plane.height, [&](std::uint32_t y) {
        const auto source = plane.row(y);
        std::vector<float> padded(radius, source.front());
        padded.insert(padded.end(), source.begin(), source.end());
        padded.insert(padded.end(), radius, source.back());
        const auto target = result.row(y);
        for (std::size_t tap = 0; tap < kernel.size(); ++tap)
            for (std::size_t x = 0; x < target.size(); ++x)
                target[x] += kernel[tap] * padded[x + tap];
    });
    return result;
}

Plane filteredAlongY(const Plane& plane, const Kernel& kernel) {
    Plane result(plane.width, plane.height);
    const auto radius = static_cast<std::int64_t>(kernel.size() / 2);
    const auto last = static_cast<std::int64_t>(plane.height) - 1;
    tbb::parallel_for(std::uint32_t{0}, plane.height, [&](std::uint32_t y) {
        const auto target = result.row(y);
        for (std::int64_t tap = -radius; tap <= radius; ++tap) {
            const std::int64_t from = std::clamp<std::int64_t>(y + tap, 0, last);
            const auto source = plane.row(static_cast<std::uint32_t>(from));
            const float weight = kernel[static_cast<std::size_t>(tap + radius)];
            for (std::size_t x = 0; x < target.size(); ++x)
                target[x] += weight * source[x];
        }
    });
    return result;
}

} // namespace lodestone
