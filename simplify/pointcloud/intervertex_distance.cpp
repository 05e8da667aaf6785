#include "simplify/pointcloud/circles.h"
#include "simplify/pointcloud/merge_builder.h"
#include "simplify/pointcloud/methods.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

// A face of three distinct roots, as the walk meets it.
struct Met {
    Triangle roots;
    Triangle3d points;
    std::array<double, 3> sides;
};

// [faces] shortest side.
std::vector<float> shortestSides(const CloudSurface& surface, const JobContext& job) {
    std::vector<float> shortest(surface.faces.size());
    for (std::size_t f = 0; f < shortest.size() && !stopsAt(f, job); ++f)
        shortest[f] = static_cast<float>(std::ranges::min(sidesOf(surface.points(f))));
    return shortest;
}

// Walks over the faces in order, once for each threshold; merge_face(builder, face, threshold)
// merges what it finds near.
template <class MergeFace>
Merges walk(const CloudSurface& surface,
            double distance,
            Fidelity fidelity,
            const JobContext& job,
            const MergeFace& merge_face) {
    constexpr double kRounding = 1e-6; // of floats
    MergeBuilder builder(surface, fidelity, job);
    const std::vector<float> shortest = shortestSides(surface, job);
    if (job.stopRequested())
        return {};
    std::vector<std::uint32_t> open(surface.faces.size()); // faces that have not collapsed
    std::iota(open.begin(), open.end(), 0u);
    for (const double threshold : thresholds(surface, distance, fidelity)) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < open.size() && !stopsAt(i, job); ++i) {
            const std::uint32_t f = open[i];
            open[kept++] = f;
            if (shortest[f] > threshold * (1.0 + kRounding) && builder.isUntouched(f))
                continue;
            const Triangle roots = builder.rootsOf(f);
            if (isCollapsed(roots)) {
                --kept;
                continue;
            }
            const Triangle3d points = builder.pointsOf(roots);
            merge_face(builder, Met{roots, points, sidesOf(points)}, threshold);
        }
        open.resize(kept);
    }
    return builder.finish();
}

} // namespace

Merges intervertexDistance(const CloudSurface& surface,
                           double distance,
                           Fidelity fidelity,
                           const JobContext& job) {
    const auto merge_near = [&](MergeBuilder& builder, const Met& met, double threshold) {
        const auto shortest =
            static_cast<std::size_t>(std::ranges::min_element(met.sides) - met.sides.begin());
        const auto near_count =
            std::ranges::count_if(met.sides, [&](double side) { return side < threshold; });
        // Two short sides meet in a vertex that is near to both others.
        if (near_count >= 2 && builder.merge(met.roots, triplexCentre(met.points, fidelity)))
            return;
        if (near_count >= 1)
            mergeSide(builder, met.roots, shortest);
    };
    return walk(surface, distance, fidelity, job, merge_near);
}

Merges vertexTriplexDistance(const CloudSurface& surface,
                             double distance,
                             Fidelity fidelity,
                             const JobContext& job) {
    const auto merge_triplex = [&](MergeBuilder& builder, const Met& met, double threshold) {
        if (std::ranges::all_of(met.sides, [&](double side) { return side < threshold; })) {
            builder.merge(met.roots, triplexCentre(met.points, fidelity));
            return;
        }
        // d12, d13, d23 in this order: the sides opposite corners 2, 1, 0.
        for (const std::size_t side : {2u, 1u, 0u}) {
            if (met.sides[side] > threshold)
                continue;
            const std::size_t a = (side + 1) % 3;
            const std::size_t b = (side + 2) % 3;
            const std::size_t longer = met.sides[a] > met.sides[b] ? a : b;
            // A far longer one would leave slivers across the surface.
            const bool fits = fidelity == Fidelity::Literal || met.sides[longer] < 2.0 * threshold;
            mergeSide(builder, met.roots, fits ? longer : side);
            return;
        }
    };
    return walk(surface, distance, fidelity, job, merge_triplex);
}

} // namespace lodestone
