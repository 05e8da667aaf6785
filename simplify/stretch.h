#pragma once
#include <glm/glm.hpp>

namespace lodestone {

// The longest that a linear map makes a unit vector: its largest singular value. Not a number if
// entries are so large that their fourth powers overflow. Source: eigenvalues of a symmetric 3x3
// matrix in closed form (Smith 1961).
double longestStretch(const glm::dmat3& linear);

// The same from the map's Gram matrix, its transpose times itself.
double longestStretchOfGram(const glm::dmat3& gram);

} // namespace lodestone
