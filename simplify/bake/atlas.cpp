#include "simplify/bake/atlas.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace lodestone {

namespace {

constexpr std::uint32_t kGap = 5;     // rows between the long sides of two that share a rectangle
constexpr std::uint32_t kPadding = 1; // around a rectangle

struct Texels {
    std::uint32_t width = 1;
    std::uint32_t height = 1;
};

Texels texelsOf(const FlatTriangle& triangle, double density, std::uint32_t most) {
    const auto whole = [&](double length, std::uint32_t limit) {
        const double texels = std::round(length * density);
        return texels >= 1.0 ? static_cast<std::uint32_t>(std::min(texels, double(limit))) : 1u;
    };
    const std::uint32_t width = whole(triangle.base, most);
    return {width, whole(triangle.height, width)};
}

// Shelf packing of pairs, the highest first. Empty if they do not fit into size x height_limit.
struct Packing {
    std::vector<AtlasPlace> places;
    std::uint64_t height = 0; // used
};

Packing pack(std::span<const FlatTriangle> triangles,
             std::span<const std::uint32_t> order,
             double density,
             std::uint32_t size) {
    const std::uint32_t most = size > 16 ? size - 16 : 1;
    Packing packing;
    packing.places.resize(triangles.size());
    std::uint64_t x = 0;
    std::uint64_t shelf = 0;
    for (std::size_t i = 0; i < order.size(); i += 2) {
        const std::size_t last = std::min(i + 1, order.size() - 1);
        const Texels a = texelsOf(triangles[order[i]], density, most);
        const Texels b = texelsOf(triangles[order[last]], density, most);
        const Texels pair{std::max(a.width, b.width), std::max(a.height, b.height)};
        const std::uint64_t across = pair.width + 1 + 2 * kPadding;
        const std::uint64_t down = pair.height + 1 + kGap + 2 * kPadding;
        if (x + across > size) {
            shelf = packing.height;
            x = 0;
        }
        packing.height = std::max(packing.height, shelf + down);
        const auto left = static_cast<std::uint32_t>(x) + kPadding;
        const auto top = static_cast<std::uint32_t>(shelf) + kPadding;
        packing.places[order[i]] = {left, top, pair.width, pair.height, false};
        if (last != i)
            packing.places[order[last]] = {
                left + pair.width, top + pair.height + kGap, pair.width, pair.height, true};
        x += across;
    }
    return packing;
}

} // namespace

Result<Atlas> packAtlas(std::span<const FlatTriangle> triangles, std::uint32_t size_px) {
    std::vector<std::uint32_t> order(triangles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
        const FlatTriangle& p = triangles[a];
        const FlatTriangle& q = triangles[b];
        return p.height > q.height || (p.height == q.height && p.base > q.base);
    });
    const auto fits = [&](double density) {
        return pack(triangles, order, density, size_px).height <= size_px;
    };
    if (!fits(0.0)) {
        std::uint32_t enough = size_px;
        while (enough < 65'536 && pack(triangles, order, 0.0, enough).height > enough)
            enough *= 2;
        return fail(ErrorKind::Usage,
                    "an atlas of " + std::to_string(size_px) + " pixels is too small for " +
                        std::to_string(triangles.size()) + " triangles; use " +
                        std::to_string(enough) + " or more, or fewer triangles");
    }
    double area = 0.0;
    for (const FlatTriangle& triangle : triangles)
        area += 0.5 * triangle.base * triangle.height;
    double low = 0.0;
    double high = area > 0.0 ? 2.0 * size_px / std::sqrt(area) : 0.0;
    for (int round = 0; round < 20 && high > 0.0; ++round) {
        const double middle = 0.5 * (low + high);
        (fits(middle) ? low : high) = middle;
    }
    return Atlas{size_px, pack(triangles, order, low, size_px).places, low};
}

} // namespace lodestone
