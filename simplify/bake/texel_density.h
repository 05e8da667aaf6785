#pragma once
// How fine the texels of a scene's base colour lie on its surface.
#include "simplify/measure/texture_images.h"

namespace lodestone {

// Sums over triangles; a mean density is that of their areas.
struct TexelArea {
    double texels = 0.0; // that the triangles cover, repeats counted
    double area = 0.0;   // of the surface

    double texelsPerUnit() const; // 0 if nothing is covered

    // Adds the triangles of a primitive that base colour texels cover. material: the primitive's;
    // stretch: factor of its instances on lengths. O(triangles).
    void add(const Geometry& geometry,
             const Material& material,
             const TextureImages& images,
             double stretch);
};

} // namespace lodestone
