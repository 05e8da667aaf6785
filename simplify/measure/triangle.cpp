#include "simplify/measure/triangle.h"

#include <algorithm>
#include <limits>

namespace lodestone {

namespace {

// A triangle seen from a point: corner a is the origin.
struct Seen {
    glm::dvec3 ab;
    glm::dvec3 ac;
    glm::dvec3 ap;
    double ab_ab = 0.0;
    double ab_ac = 0.0;
    double ac_ac = 0.0;
    double ap_ab = 0.0;
    double ap_ac = 0.0;
    // Barycentric weights of the foot point on the plane, times area2.
    double u = 0.0;
    double v = 0.0;
    double w = 0.0;
    double area2 = 0.0; // squared length of the normal
    bool flat = false;  // no area to speak of: no plane either

    Seen(const glm::dvec3& point, const Triangle& triangle)
        : ab(triangle[1] - triangle[0]), ac(triangle[2] - triangle[0]), ap(point - triangle[0]),
          ab_ab(glm::dot(ab, ab)), ab_ac(glm::dot(ab, ac)), ac_ac(glm::dot(ac, ac)),
          ap_ab(glm::dot(ap, ab)), ap_ac(glm::dot(ap, ac)) {
        area2 = ab_ab * ac_ac - ab_ac * ab_ac;
        v = ac_ac * ap_ab - ab_ac * ap_ac;
        w = ab_ab * ap_ac - ab_ac * ap_ab;
        u = area2 - v - w;
        flat = !(area2 > 1e-14 * ab_ab * ac_ac);
    }

    bool inside() const { return !flat && u >= 0.0 && v >= 0.0 && w >= 0.0; }
};

// The closest point of a side: start + share * along.
struct OnSide {
    double distance2 = std::numeric_limits<double>::infinity();
    int side = 0; // from corner `side` to the next
    double share = 0.0;

    // from: from the side's start to the point. projected: from * along.
    void offer(int number, const glm::dvec3& from, const glm::dvec3& along, double projected) {
        const double length2 = glm::dot(along, along);
        const double at = length2 > 0.0 ? std::clamp(projected / length2, 0.0, 1.0) : 0.0;
        const glm::dvec3 apart = from - at * along;
        const double squared = glm::dot(apart, apart);
        if (squared < distance2)
            *this = {squared, number, at};
    }
};

// A closest point that is not inside lies on a side that the foot point is outside of.
OnSide closestOnSides(const Seen& seen) {
    OnSide best;
    if (seen.flat || seen.w < 0.0)
        best.offer(0, seen.ap, seen.ab, seen.ap_ab);
    if (seen.flat || seen.u < 0.0) {
        const glm::dvec3 bp = seen.ap - seen.ab;
        const glm::dvec3 bc = seen.ac - seen.ab;
        best.offer(1, bp, bc, glm::dot(bp, bc));
    }
    if (seen.flat || seen.v < 0.0) {
        const glm::dvec3 cp = seen.ap - seen.ac;
        best.offer(2, cp, -seen.ac, -glm::dot(cp, seen.ac));
    }
    return best;
}

} // namespace

double squaredDistance(const glm::dvec3& point, const Triangle& triangle) {
    const Seen seen(point, triangle);
    if (!seen.inside())
        return closestOnSides(seen).distance2;
    const glm::dvec3 normal = glm::cross(seen.ab, seen.ac);
    const double height = glm::dot(normal, seen.ap);
    return height * height / glm::dot(normal, normal);
}

glm::dvec3 closestWeights(const glm::dvec3& point, const Triangle& triangle) {
    const Seen seen(point, triangle);
    if (seen.inside())
        return {1.0 - (seen.v + seen.w) / seen.area2, seen.v / seen.area2, seen.w / seen.area2};
    const OnSide best = closestOnSides(seen);
    glm::dvec3 weights(0.0);
    weights[best.side] = 1.0 - best.share;
    weights[(best.side + 1) % 3] = best.share;
    return weights;
}

} // namespace lodestone
