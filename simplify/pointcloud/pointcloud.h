#pragma once
#include "simplify/algorithm.h"

namespace lodestone {

// Rows of the six point-cloud methods.
Algorithm vertexTriplexAlgorithm();

} // namespace lodestone
