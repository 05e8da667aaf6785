#include "app/scene_texels.h"

#include "app/view_state.h"
#include "scene/decoded_image.h"
#include "simplify/bake/texel_density.h"

#include <cmath>

namespace lodestone {

double texelsPerUnit(const Scene& scene) {
    std::vector<glm::ivec2> sizes;
    sizes.reserve(scene.images.size());
    for (const Image& image : scene.images)
        sizes.push_back(imageSize(image));
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    TexelArea all;
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s) {
        TexelArea one;
        for (const Primitive& primitive : scene.submeshes[s].primitives) {
            if (primitive.material == kNone || primitive.mode != PrimitiveMode::Triangles)
                continue;
            const TextureRef& texture = scene.materials[primitive.material].base_color_texture;
            if (texture.image < sizes.size() && sizes[texture.image].x > 0)
                one.add(*primitive.geometry, texture, sizes[texture.image], 1.0);
        }
        if (one.area <= 0.0)
            continue;
        for (std::uint32_t i = ranges[s].begin; i < ranges[s].end; ++i) {
            const double volume = glm::determinant(glm::dmat3(scene.instances[i].transform));
            all.texels += one.texels;
            all.area += one.area * std::pow(std::abs(volume), 2.0 / 3.0);
        }
    }
    return all.texelsPerUnit();
}

double texelsFull(double mean_per_unit) {
    return mean_per_unit > 0.0 ? mean_per_unit * std::sqrt(kTexelSpan) : 1.0;
}

} // namespace lodestone
