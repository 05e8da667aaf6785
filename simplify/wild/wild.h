#pragma once
// Simplification of meshes in the wild (Liu et al. 2024): any triangles, many components.
#include "simplify/algorithm.h"

namespace lodestone {

// Row "wild": pairs of vertices collapse along edges and across gaps, with area kept at borders.
Algorithm wildAlgorithm();

} // namespace lodestone
