#include "simplify/pointcloud/circles.h"
#include "simplify/pointcloud/merge_builder.h"
#include "simplify/pointcloud/methods.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

// Sides of a triangle; side k lies opposite corner k.
std::array<double, 3> sidesOf(const Triangle3d& points) {
    return {glm::distance(points[1], points[2]),
            glm::distance(points[2], points[0]),
            glm::distance(points[0], points[1])};
}

bool isCollapsed(const Triangle& roots) {
    return roots[0] == roots[1] || roots[1] == roots[2] || roots[2] == roots[0];
}

bool mergeSide(MergeBuilder& builder, const Triangle& roots, std::size_t side) {
    const std::array<std::uint32_t, 2> ends{roots[(side + 1) % 3], roots[(side + 2) % 3]};
    return builder.merge(ends, (builder.position(ends[0]) + builder.position(ends[1])) * 0.5);
}

double diagonalOf(const CloudSurface& surface) {
    Bounds bounds;
    for (const glm::dvec3& position : surface.positions)
        bounds.add(position);
    return bounds.diagonal();
}

// The thresholds of the walks that lead to `distance`: short sides go before long ones, so that a
// long one that merged early does not stop its surroundings from merging, and a larger threshold
// starts from what a smaller one made. The steps before the last do not depend on `distance`.
std::vector<double> thresholds(const CloudSurface& surface, double distance, Fidelity fidelity) {
    constexpr int kFewest = -9; // of the diagonal, as a power of two
    std::vector<double> steps;
    if (fidelity == Fidelity::Sound) {
        const double diagonal = diagonalOf(surface);
        for (int power = kFewest; std::ldexp(diagonal, power) < distance; ++power)
            steps.push_back(std::ldexp(diagonal, power));
    }
    steps.push_back(distance);
    return steps;
}

void walkByDistance(const CloudSurface& surface,
                    MergeBuilder& builder,
                    double distance,
                    Fidelity fidelity,
                    const JobContext& job) {
    for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const Triangle roots = builder.rootsOf(f);
        if (isCollapsed(roots))
            continue;
        const Triangle3d points = builder.pointsOf(roots);
        const std::array<double, 3> sides = sidesOf(points);
        const auto shortest =
            static_cast<std::size_t>(std::ranges::min_element(sides) - sides.begin());
        const auto near_count =
            std::ranges::count_if(sides, [&](double side) { return side < distance; });
        // Two short sides meet in a vertex that is near to both others.
        if (near_count >= 2 && builder.merge(roots, triplexCentre(points, fidelity)))
            continue;
        if (near_count >= 1)
            mergeSide(builder, roots, shortest);
    }
}

void walkByTriplex(const CloudSurface& surface,
                   MergeBuilder& builder,
                   double distance,
                   Fidelity fidelity,
                   const JobContext& job) {
    for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const Triangle roots = builder.rootsOf(f);
        if (isCollapsed(roots))
            continue;
        const Triangle3d points = builder.pointsOf(roots);
        const std::array<double, 3> sides = sidesOf(points);
        if (std::ranges::all_of(sides, [&](double side) { return side < distance; })) {
            builder.merge(roots, triplexCentre(points, fidelity));
            continue;
        }
        // d12, d13, d23 in this order: the sides opposite corners 2, 1, 0.
        for (const std::size_t side : {2u, 1u, 0u}) {
            if (sides[side] > distance)
                continue;
            const std::size_t a = (side + 1) % 3;
            const std::size_t b = (side + 2) % 3;
            const std::size_t longer = sides[a] > sides[b] ? a : b;
            // A far longer one would leave slivers across the surface.
            const bool fits = fidelity == Fidelity::Literal || sides[longer] < 2.0 * distance;
            mergeSide(builder, roots, fits ? longer : side);
            break;
        }
    }
}

} // namespace

Merges intervertexDistance(const CloudSurface& surface,
                           double distance,
                           Fidelity fidelity,
                           const JobContext& job) {
    MergeBuilder builder(surface, fidelity);
    for (const double step : thresholds(surface, distance, fidelity))
        walkByDistance(surface, builder, step, fidelity, job);
    return builder.finish();
}

Merges vertexTriplexDistance(const CloudSurface& surface,
                             double distance,
                             Fidelity fidelity,
                             const JobContext& job) {
    MergeBuilder builder(surface, fidelity);
    for (const double step : thresholds(surface, distance, fidelity))
        walkByTriplex(surface, builder, step, fidelity, job);
    return builder.finish();
}

} // namespace lodestone
