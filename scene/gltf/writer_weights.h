#pragma once
// Skinning weights of simplified meshes.
#include "scene/scene.h"

namespace lodestone {

// A WEIGHTS_n attribute of the geometry, scaled so that all sets of a vertex add up to 1, in their
// own type to the last unit. Vertices that add up already, or to nothing, stay as they are.
Attribute normalizedWeights(const Geometry& geometry, const Attribute& weights);

} // namespace lodestone
