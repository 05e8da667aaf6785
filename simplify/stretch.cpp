#include "simplify/stretch.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

double longestStretch(const glm::dmat3& linear) {
    return longestStretchOfGram(glm::transpose(linear) * linear);
}

double longestStretchOfGram(const glm::dmat3& gram) {
    const double mean = (gram[0][0] + gram[1][1] + gram[2][2]) / 3.0;
    const glm::dmat3 rest = gram - glm::dmat3(mean);
    double spread2 = 0.0;
    for (int column = 0; column < 3; ++column)
        spread2 += glm::dot(rest[column], rest[column]);
    const double spread = std::sqrt(spread2 / 6.0);
    if (spread <= 1e-12 * mean)
        return std::sqrt(mean);
    const double cosine = std::clamp(0.5 * glm::determinant(rest / spread), -1.0, 1.0);
    return std::sqrt(mean + 2.0 * spread * std::cos(std::acos(cosine) / 3.0));
}

} // namespace lodestone
