#pragma once
// What a scene's materials say at any point of a triangle.
#include "simplify/measure/texture_images.h"

namespace lodestone {

// Factors, textures and vertex colours multiplied; linear but where said.
struct SurfaceLook {
    glm::vec4 base_color{1.0f};
    glm::vec3 normal{0.0f, 0.0f, 1.0f}; // unit, in the submesh's space; normal texture applied
    float occlusion = 1.0f;
    float roughness = 1.0f;
    float metallic = 1.0f;
    glm::vec3 emissive{0.0f};
};

// Immutable once made; any number of threads.
class TextureSampler {
public:
    // Decodes every image that a material uses. scene must outlive it.
    explicit TextureSampler(const Scene& scene);

    // corners: vertices of the geometry. material: index or kNone.
    SurfaceLook at(const Geometry& geometry,
                   std::uint32_t material,
                   const std::array<std::uint32_t, 3>& corners,
                   const glm::vec3& weights) const;

    const TextureImages& images() const { return images_; }

    const std::vector<std::string>& notes() const { return images_.notes(); }

private:
    glm::vec3 shadingNormal(const Geometry& geometry,
                            const Material& material,
                            const std::array<std::uint32_t, 3>& corners,
                            const glm::vec3& weights) const;

    const Scene& scene_;
    TextureImages images_;
};

} // namespace lodestone
