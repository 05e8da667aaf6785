#pragma once
// Closest points of triangles in single precision, for the millions of them that a bake asks for.
#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>

namespace lodestone {

// Weights of the closest point of a triangle (Ericson 2005, 5.1.5); sum 1, in
// [0, 1]. A triangle without area has them, too.
inline glm::vec3 closestOn(const glm::vec3& p, const std::array<glm::vec3, 3>& t) {
    const glm::vec3 ab = t[1] - t[0];
    const glm::vec3 ac = t[2] - t[0];
    const glm::vec3 ap = p - t[0];
    const float d1 = glm::dot(ab, ap);
    const float d2 = glm::dot(ac, ap);
    if (d1 <= 0.0f && d2 <= 0.0f)
        return {1.0f, 0.0f, 0.0f};
    const glm::vec3 bp = p - t[1];
    const float d3 = glm::dot(ab, bp);
    const float d4 = glm::dot(ac, bp);
    if (d3 >= 0.0f && d4 <= d3)
        return {0.0f, 1.0f, 0.0f};
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0f && d1 >= 0.0f && d3 <= 0.0f) {
        const float v = d1 / std::max(d1 - d3, std::numeric_limits<float>::min());
        return {1.0f - v, v, 0.0f};
    }
    const glm::vec3 cp = p - t[2];
    const float d5 = glm::dot(ab, cp);
    const float d6 = glm::dot(ac, cp);
    if (d6 >= 0.0f && d5 <= d6)
        return {0.0f, 0.0f, 1.0f};
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0f && d2 >= 0.0f && d6 <= 0.0f) {
        const float w = d2 / std::max(d2 - d6, std::numeric_limits<float>::min());
        return {1.0f - w, 0.0f, w};
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0.0f && d4 - d3 >= 0.0f && d5 - d6 >= 0.0f) {
        const float w =
            (d4 - d3) / std::max((d4 - d3) + (d5 - d6), std::numeric_limits<float>::min());
        return {0.0f, 1.0f - w, w};
    }
    const float sum = va + vb + vc;
    if (!(sum > 0.0f))
        return {1.0f, 0.0f, 0.0f};
    return {va / sum, vb / sum, vc / sum};
}

// The point of a triangle with those weights.
inline glm::vec3 blended(const std::array<glm::vec3, 3>& t, const glm::vec3& weights) {
    return t[0] * weights.x + t[1] * weights.y + t[2] * weights.z;
}

} // namespace lodestone
