#pragma once
// Quadric simplification (Garland and Heckbert 1997): the baseline that knows no instances.
#include "simplify/algorithm.h"

namespace lodestone {

// Row "quadric": the scene is expanded first, as today's tools do.
Algorithm quadricAlgorithm();
// Row "quadric-submesh": every submesh by itself; instance counts and scales are ignored.
Algorithm quadricSubmeshAlgorithm();

} // namespace lodestone
