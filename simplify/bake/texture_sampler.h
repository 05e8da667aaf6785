#pragma once
// What a scene's materials say at any point of a triangle.
#include "scene/decoded_image.h"

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
    // Decodes every image that a material uses, in parallel; those that cannot be read count as
    // white and are named in notes(). scene must outlive it.
    explicit TextureSampler(const Scene& scene);

    // corners: vertices of the geometry. material: index or kNone.
    SurfaceLook at(const Geometry& geometry,
                   std::uint32_t material,
                   const std::array<std::uint32_t, 3>& corners,
                   const glm::vec3& weights) const;

    const std::vector<std::string>& notes() const { return notes_; }

private:
    enum class Coding : std::uint8_t { Linear, Srgb };

    glm::vec4 sample(const Geometry& geometry,
                     const TextureRef& texture,
                     const std::array<std::uint32_t, 3>& corners,
                     const glm::vec3& weights,
                     Coding coding) const;
    glm::vec3 shadingNormal(const Geometry& geometry,
                            const Material& material,
                            const std::array<std::uint32_t, 3>& corners,
                            const glm::vec3& weights) const;

    const Scene& scene_;
    std::vector<DecodedImage> images_; // [scene.images], empty where no material uses it
    std::vector<std::string> notes_;
};

// An attribute at a point of a triangle; components beyond its own stay `fallback`.
glm::vec4 blendAttribute(const Attribute& attribute,
                         const std::array<std::uint32_t, 3>& corners,
                         const glm::vec3& weights,
                         const glm::vec4& fallback);

} // namespace lodestone
