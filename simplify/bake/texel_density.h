#pragma once
// How fine the texels of a scene's base colour lie on its surface.
#include "scene/scene.h"

namespace lodestone {

// Sums over triangles; a mean density is that of their areas.
struct TexelArea {
    double texels = 0.0; // that the triangles cover, repeats counted
    double area = 0.0;   // of the surface

    double texelsPerUnit() const; // 0 if nothing is covered

    // Adds the triangles of a primitive; nothing without the texture's coordinates. size_px: of
    // the texture's image; stretch: factor of the primitive's instances on lengths. O(triangles).
    void add(const Geometry& geometry,
             const TextureRef& texture,
             const glm::dvec2& size_px,
             double stretch);
};

} // namespace lodestone
