#pragma once
// Instance-aware simplification (Azim, Cheslack-Postava, Levis 2015).
#include "simplify/algorithm.h"

namespace lodestone {

// Row "ias": submesh edges collapse with the error of all their instances, in closed form.
Algorithm iasAlgorithm();

} // namespace lodestone
