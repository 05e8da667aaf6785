#pragma once
// The texels and vertex colours at any point of a scene's triangles.
#include "scene/decoded_image.h"

namespace lodestone {

// Decoded images of a scene's materials. Immutable once made; any number of threads.
class TextureImages {
public:
    enum class Coding : std::uint8_t { Linear, Srgb };
    using Slot = TextureRef Material::*; // &Material::base_color_texture

    // Decodes what the materials have in these slots, in parallel: PNG, JPEG and WebP (whatever
    // decodeImage knows); others are named in notes() and count as white. scene must outlive it.
    TextureImages(const Scene& scene, std::span<const Slot> slots);

    // Whether there are texels and the geometry has coordinates for them.
    bool covers(const Geometry& geometry, const TextureRef& texture) const;

    // Width and height in texels; 0 for what is not there.
    glm::ivec2 size(std::uint32_t image) const;

    // Bilinear or nearest, wrapped as the reference says; white where nothing covers the geometry.
    // Linear: Srgb decodes red, green and blue. corners: vertices of the geometry.
    glm::vec4 sample(const Geometry& geometry,
                     const TextureRef& texture,
                     const std::array<std::uint32_t, 3>& corners,
                     const glm::vec3& weights,
                     Coding coding) const;

    const std::vector<std::string>& notes() const { return notes_; }

private:
    std::vector<DecodedImage> images_; // [scene.images], empty where no slot uses it
    std::vector<std::string> notes_;
};

// An attribute at a point of a triangle; components beyond its own stay `fallback`.
glm::vec4 blendAttribute(const Attribute& attribute,
                         const std::array<std::uint32_t, 3>& corners,
                         const glm::vec3& weights,
                         const glm::vec4& fallback);

// COLOR_0 at a point of a triangle; white where there is none.
glm::vec4 vertexColorAt(const Geometry& geometry,
                        const std::array<std::uint32_t, 3>& corners,
                        const glm::vec3& weights);

} // namespace lodestone
