#pragma once
#include "scene/scene.h"

namespace lodestone {

// How many texels of the base colour lie along a world unit of a scene's textured surface: the mean
// over its area, instances counted (each as large as its transform makes it on the whole). 0 if
// nothing is textured. Any thread; O(triangles + instances), images are not decoded.
double texelsPerUnit(const Scene& scene);

// Texels a world unit that the last colour of ShadingMode::Texels stands for: a mean, as above, is
// in the middle of the scale. > 0.
double texelsFull(double mean_per_unit);

} // namespace lodestone
