#pragma once
// The colour of any point of a scene's surface.
#include "simplify/measure/texture_images.h"

namespace lodestone {

// Immutable once made; any number of threads.
class SurfaceColors {
public:
    // Decodes the base colour images of the scene's materials. scene must outlive it.
    explicit SurfaceColors(const Scene& scene);

    // sRGB, 0..1 each, of a point of a triangle. geometry: drawn with that material (index or
    // kNone), has the scene's attributes. triangle < its count.
    glm::dvec3 at(const Geometry& geometry,
                  std::uint32_t material,
                  std::size_t triangle,
                  const glm::dvec3& weights) const;

    const std::vector<std::string>& notes() const { return images_.notes(); }

private:
    const Scene& scene_;
    TextureImages images_;
};

} // namespace lodestone
