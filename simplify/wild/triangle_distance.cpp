#include "simplify/wild/triangle_distance.h"

#include <algorithm>
#include <cmath>

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

// A triangle and how far another one's corners lie off its plane.
struct PlaneSide {
    glm::dvec3 normal{0.0};  // any length
    double length = 0.0;     // of the normal
    glm::dvec3 heights{0.0}; // of the other's corners, x length

    PlaneSide(const Triangle& of, const Triangle& other)
        : normal(glm::cross(of[1] - of[0], of[2] - of[0])), length(glm::length(normal)) {
        for (int k = 0; k < 3; ++k)
            heights[k] = glm::dot(normal, other[static_cast<std::size_t>(k)] - of[0]);
    }

    bool farther(std::size_t corner, double distance) const {
        return std::abs(heights[static_cast<int>(corner)]) > distance * length;
    }

    // Whether an edge of the other triangle, from a corner to the next, lies on one side, farther
    // off than that.
    bool edgeFarther(std::size_t corner, double distance) const {
        const double from = heights[static_cast<int>(corner)];
        const double to = heights[static_cast<int>((corner + 1) % 3)];
        return std::min(from, to) > distance * length || std::max(from, to) < -distance * length;
    }

    // Whether the whole other triangle lies on one side, farther off than that.
    bool aside(double distance) const {
        const double limit = distance * length;
        return (heights.x > limit && heights.y > limit && heights.z > limit) ||
               (heights.x < -limit && heights.y < -limit && heights.z < -limit);
    }
};

// Where an edge of one triangle crosses the other's inside; nothing where they are parallel.
std::optional<glm::dvec3>
crossing(const Triangle& edges, const Triangle& t, const PlaneSide& side) {
    for (int k = 0; k < 3; ++k) {
        const double before = side.heights[k];
        const double after = side.heights[(k + 1) % 3];
        if (!(before * after < 0.0))
            continue;
        const glm::dvec3& p = edges[static_cast<std::size_t>(k)];
        const glm::dvec3& q = edges[static_cast<std::size_t>((k + 1) % 3)];
        const glm::dvec3 x = p + (q - p) * (before / (before - after));
        bool inside = true;
        for (std::size_t l = 0; l < 3 && inside; ++l)
            inside = !(glm::dot(side.normal, glm::cross(t[(l + 1) % 3] - t[l], x - t[l])) < 0.0);
        if (inside)
            return x;
    }
    return std::nullopt;
}

// The nearest pair of points so far.
struct Nearest {
    double distance;
    double distance2;
    std::array<glm::dvec3, 2> at;

    void offer(const glm::dvec3& on_a, const glm::dvec3& on_b) {
        const glm::dvec3 gap = on_a - on_b;
        const double gap2 = glm::dot(gap, gap);
        if (!(gap2 < distance2))
            return;
        distance = std::sqrt(gap2);
        distance2 = gap2;
        at = {on_a, on_b};
    }
};

// Whether the boxes of two segments are farther apart than that along an axis.
bool boxesApart(const glm::dvec3& p,
                const glm::dvec3& p_to,
                const glm::dvec3& q,
                const glm::dvec3& q_to,
                double distance) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::min(p[axis], p_to[axis]) - std::max(q[axis], q_to[axis]) > distance ||
            std::min(q[axis], q_to[axis]) - std::max(p[axis], p_to[axis]) > distance)
            return true;
    return false;
}

} // namespace

std::optional<TriangleGap> triangleGap(const Triangle& a, const Triangle& b, double below) {
    const PlaneSide off_a(a, b);
    if (!(below > 0.0) || off_a.aside(below))
        return std::nullopt;
    const PlaneSide off_b(b, a);
    if (off_b.aside(below))
        return std::nullopt;
    auto crossed = crossing(b, a, off_a);
    if (!crossed)
        crossed = crossing(a, b, off_b);
    if (crossed)
        return TriangleGap{0.0, {*crossed, *crossed}};
    Nearest best{below, below * below, {}};
    for (std::size_t k = 0; k < 3 && best.distance > 0.0; ++k) {
        if (!off_b.farther(k, best.distance))
            best.offer(a[k], closestPoint(a[k], b));
        if (!off_a.farther(k, best.distance))
            best.offer(closestPoint(b[k], a), b[k]);
    }
    for (std::size_t k = 0; k < 3 && best.distance > 0.0; ++k) {
        if (off_b.edgeFarther(k, best.distance))
            continue;
        const glm::dvec3& a_to = a[(k + 1) % 3];
        for (std::size_t l = 0; l < 3; ++l) {
            const glm::dvec3& b_to = b[(l + 1) % 3];
            if (off_a.edgeFarther(l, best.distance) ||
                boxesApart(a[k], a_to, b[l], b_to, best.distance))
                continue;
            const auto at = closestOfSegments(a[k], a_to - a[k], b[l], b_to - b[l]);
            best.offer(at[0], at[1]);
        }
    }
    if (!(best.distance < below))
        return std::nullopt;
    return TriangleGap{best.distance, best.at};
}

} // namespace lodestone
