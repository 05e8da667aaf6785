#include "simplify/measure/surface_color.h"

#include "simplify/measure/srgb.h"

#include <array>

namespace lodestone {

namespace {

constexpr std::array<TextureImages::Slot, 1> kSlots{&Material::base_color_texture};

} // namespace

SurfaceColors::SurfaceColors(const Scene& scene) : scene_(scene), images_(scene, kSlots) {}

glm::dvec3 SurfaceColors::at(const Geometry& geometry,
                             std::uint32_t material_index,
                             std::size_t triangle,
                             const glm::dvec3& weights) const {
    const std::uint32_t* indices = geometry.indices.data() + 3 * triangle;
    const std::array<std::uint32_t, 3> corners{indices[0], indices[1], indices[2]};
    const glm::vec3 blend(weights);
    glm::vec3 linear(vertexColorAt(geometry, corners, blend));
    if (material_index < scene_.materials.size()) {
        const Material& material = scene_.materials[material_index];
        linear *=
            glm::vec3(material.base_color) * glm::vec3(images_.sample(geometry,
                                                                      material.base_color_texture,
                                                                      corners,
                                                                      blend,
                                                                      TextureImages::Coding::Srgb));
    }
    return {srgbFromLinear(linear.x), srgbFromLinear(linear.y), srgbFromLinear(linear.z)};
}

} // namespace lodestone
