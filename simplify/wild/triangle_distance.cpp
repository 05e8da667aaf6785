#include "simplify/wild/triangle_distance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace lodestone {

namespace {

// Closest points of two segments p + s u, q + t v with s, t in [0, 1] (Ericson 2005, 5.1.9).
std::array<glm::dvec3, 2> closestOfSegments(const glm::dvec3& p,
                                            const glm::dvec3& u,
                                            const glm::dvec3& q,
                                            const glm::dvec3& v) {
    const glm::dvec3 r = p - q;
    const double uu = glm::dot(u, u);
    const double vv = glm::dot(v, v);
    const double uv = glm::dot(u, v);
    const double ur = glm::dot(u, r);
    const double vr = glm::dot(v, r);
    const auto ratio = [](double over, double under) {
        return under > 0.0 ? std::clamp(over / under, 0.0, 1.0) : 0.0;
    };
    double s = ratio(uv * vr - ur * vv, uu * vv - uv * uv);
    double t = vv > 0.0 ? (uv * s + vr) / vv : 0.0;
    if (t < 0.0 || t > 1.0 || !(vv > 0.0)) {
        t = std::clamp(t, 0.0, 1.0);
        s = ratio(uv * t - ur, uu);
    }
    return {p + u * s, q + v * t};
}

glm::dvec3 closestPoint(const glm::dvec3& point, const Triangle& triangle) {
    const glm::dvec3 weights = closestWeights(point, triangle);
    return triangle[0] * weights.x + triangle[1] * weights.y + triangle[2] * weights.z;
}

// Where a segment crosses a triangle's inside; nothing where they are parallel.
std::optional<glm::dvec3> crossing(const glm::dvec3& p, const glm::dvec3& q, const Triangle& t) {
    const glm::dvec3 normal = glm::cross(t[1] - t[0], t[2] - t[0]);
    const double before = glm::dot(normal, p - t[0]);
    const double after = glm::dot(normal, q - t[0]);
    if (!(before * after < 0.0))
        return std::nullopt;
    const glm::dvec3 x = p + (q - p) * (before / (before - after));
    for (std::size_t k = 0; k < 3; ++k)
        if (glm::dot(normal, glm::cross(t[(k + 1) % 3] - t[k], x - t[k])) < 0.0)
            return std::nullopt;
    return x;
}

// Whether a triangle lies on one side of another's plane, farther from it than a distance.
bool aside(const Triangle& a, const Triangle& b, double distance) {
    const glm::dvec3 normal = glm::cross(a[1] - a[0], a[2] - a[0]);
    const double limit = distance * glm::length(normal);
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const glm::dvec3& p : b) {
        const double height = glm::dot(normal, p - a[0]);
        low = std::min(low, height);
        high = std::max(high, height);
    }
    return low > limit || high < -limit;
}

} // namespace

bool surelyApart(const Triangle& a, const Triangle& b, double distance) {
    return aside(a, b, distance) || aside(b, a, distance);
}

TriangleGap triangleGap(const Triangle& a, const Triangle& b) {
    TriangleGap best{std::numeric_limits<double>::infinity(), {}};
    const auto offer = [&](const glm::dvec3& on_a, const glm::dvec3& on_b) {
        const double distance = glm::length(on_a - on_b);
        if (distance < best.distance)
            best = {distance, {on_a, on_b}};
    };
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        if (const auto x = crossing(a[k], a[next], b))
            return {0.0, {*x, *x}};
        if (const auto x = crossing(b[k], b[next], a))
            return {0.0, {*x, *x}};
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t next = (k + 1) % 3;
        offer(a[k], closestPoint(a[k], b));
        offer(closestPoint(b[k], a), b[k]);
        for (std::size_t l = 0; l < 3; ++l) {
            const auto at = closestOfSegments(a[k], a[next] - a[k], b[l], b[(l + 1) % 3] - b[l]);
            offer(at[0], at[1]);
        }
    }
    return best;
}

} // namespace lodestone
