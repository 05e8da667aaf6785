#pragma once
// Whether every component is a finite number. O(1), any thread.
#include <cmath>
#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

namespace lodestone {

template <typename T>
bool isFinite(const glm::vec<3, T>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <typename T>
bool isFinite(const glm::vec<4, T>& v) {
    return isFinite(glm::vec<3, T>(v)) && std::isfinite(v.w);
}

template <typename T>
bool isFinite(const glm::mat<4, 4, T>& m) {
    return isFinite(m[0]) && isFinite(m[1]) && isFinite(m[2]) && isFinite(m[3]);
}

} // namespace lodestone
