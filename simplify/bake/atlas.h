#pragma once
// A texture atlas of triangles flattened one by one (Yuksel 2017): every texel belongs to at most
// one point of the surface, and no filter reaches from one triangle into another.
#include "scene/result.h"

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lodestone {

// A triangle as it is flattened: its longest side along the base, sheared to a right angle.
struct FlatTriangle {
    double base = 0.0;   // length of the longest side
    double height = 0.0; // distance of the third corner to it
};

// Where a triangle lies, in texels. The corners are texel centres.
struct AtlasPlace {
    std::uint32_t x = 0; // of the right angle
    std::uint32_t y = 0;
    std::uint32_t width = 1;  // texels from the right angle to the end of the base, >= 1
    std::uint32_t height = 1; // to the third corner, >= 1
    bool turned = false;      // by 180 degrees: extends towards smaller x and y

    // Texel centre of a point given by its shares of base and height.
    glm::dvec2 at(double along_base, double along_height) const {
        const double sign = turned ? -1.0 : 1.0;
        return {x + 0.5 + sign * along_base * width, y + 0.5 + sign * along_height * height};
    }
};

struct Atlas {
    std::uint32_t size_px = 0;      // of a side
    std::vector<AtlasPlace> places; // [triangles]
    double texels_per_unit = 0.0;   // along a length of the triangles
};

// Packs triangles at the highest equal density that fits. Two share a rectangle, their long sides
// 4 texels apart; rectangles keep a texel between them. O(triangles log triangles).
// Errors: Usage if they do not fit even at a texel each; says which size would.
Result<Atlas> packAtlas(std::span<const FlatTriangle> triangles, std::uint32_t size_px);

// Calls visit(x, y, along_base, along_height) for the texels that a bilinear filter may touch
// inside a triangle; shares are those of the triangle's nearest point. No texel is visited for two
// triangles.
template <class Visit>
void forEachTexel(const AtlasPlace& place, Visit visit) {
    const double w = place.width;
    const double h = place.height;
    for (std::int64_t j = -1; j <= std::int64_t{place.height} + 1; ++j)
        for (std::int64_t i = -1; i <= std::int64_t{place.width} + 1; ++i) {
            double u = static_cast<double>(i) / w;
            double v = static_cast<double>(j) / h;
            if (u + v >= 1.0 + 1.0 / w + 1.0 / h)
                continue;
            u = u < 0.0 ? 0.0 : u;
            v = v < 0.0 ? 0.0 : v;
            if (u + v > 1.0) { // to the long side, along the axes' mean
                const double over = 0.5 * (u + v - 1.0);
                u -= over;
                v -= over;
                if (u < 0.0 || v < 0.0) {
                    u = u < 0.0 ? 0.0 : 1.0;
                    v = 1.0 - u;
                }
            }
            const std::int64_t sign = place.turned ? -1 : 1;
            visit(static_cast<std::uint32_t>(place.x + sign * i),
                  static_cast<std::uint32_t>(place.y + sign * j),
                  u,
                  v);
        }
}

} // namespace lodestone
