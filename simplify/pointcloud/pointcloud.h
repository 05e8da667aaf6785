#pragma once
#include "simplify/algorithm.h"

namespace lodestone {

// Rows of the six point-cloud methods. Each has a main parameter: 0 lets it follow the target,
// another value is used as it is.
Algorithm vertexTriplexAlgorithm();         // VT
Algorithm faceAngleAlgorithm();             // FAD
Algorithm intervertexDistanceAlgorithm();   // IVDD
Algorithm sphericalScanningAlgorithm();     // SS
Algorithm vertexTriplexDistanceAlgorithm(); // VTD
Algorithm faceAngleScanningAlgorithm();     // FASS

} // namespace lodestone
