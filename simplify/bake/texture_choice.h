#pragma once
// Whether a new atlas pays: what a group's triangles show with it, and with the texture coordinates
// that the collapses carried along.
#include "simplify/bake/baked_group.h"

namespace lodestone {

// Distances of base colours from what the original shows there, sRGB 0..sqrt(3), plus those of
// alpha where it shows; means over the area.
struct TextureErrors {
    double kept = 0.0;
    double baked = 0.0;
};

// Ten points a triangle, of at most about 2,000 triangles. pixels: of the group. Parallel; the same
// for any number of threads. O(points * splits a point crosses).
TextureErrors textureErrors(const BakedGroup& group,
                            const BakedPixels& pixels,
                            std::span<const BakeSource> sources,
                            const TextureSampler& sampler);

} // namespace lodestone
