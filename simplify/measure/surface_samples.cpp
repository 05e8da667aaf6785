#include "simplify/measure/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::size_t kPatchTriangles = 1024;

// Random bits from a counter (SplitMix64; Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t value) {
    value += 0x9E3779B97F4A7C15ull;
    value = (value ^ (value >> 30)) * 0xBF58476D1CE4E5B9ull;
    value = (value ^ (value >> 27)) * 0x94D049BB133111EBull;
    return value ^ (value >> 31);
}

// Uniform in [0, 1). dimension 0..2 of sample k.
double uniform(std::uint64_t seed, std::uint64_t sample, std::uint64_t dimension) {
    return static_cast<double>(mixed(mixed(seed) + 3 * sample + dimension) >> 11) * 0x1p-53;
}

// Barycentric weights, uniform over a triangle's area.
glm::dvec3 weightsAt(double u, double v) {
    const double root = std::sqrt(u);
    return {1.0 - root, root * (1.0 - v), root * v};
}

glm::dvec3 pointAt(const Triangle& triangle, const glm::dvec3& weights) {
    return triangle[0] * weights.x + triangle[1] * weights.y + triangle[2] * weights.z;
}

} // namespace

Result<SurfaceSampler> SurfaceSampler::build(std::span<const SurfacePiece> pieces,
                                             const JobContext& job) {
    SurfaceSampler sampler;
    sampler.pieces_ = pieces;
    for (std::uint32_t p = 0; p < pieces.size(); ++p) {
        const std::size_t triangle_count = pieces[p].geometry->triangleCount();
        for (std::size_t t = 0; t < triangle_count; t += kPatchTriangles)
            sampler.patches_.push_back({p, t, std::min(t + kPatchTriangles, triangle_count)});
    }
    std::vector<double> areas(sampler.patches_.size());
    tbb::parallel_for(std::size_t{0}, areas.size(), [&](std::size_t i) {
        if (job.stopRequested())
            return;
        const Patch& patch = sampler.patches_[i];
        for (std::size_t t = patch.first_triangle; t < patch.last_triangle; ++t)
            areas[i] += areaOf(pieces[patch.piece].triangle(t));
    });
    if (job.stopRequested())
        return cancelled();
    sampler.area_before_.assign(1, 0.0);
    for (const double area : areas)
        sampler.area_before_.push_back(sampler.area_before_.back() + area);
    if (!(sampler.area() > 0.0))
        return badInput("distance: no triangle with an area; choose a scene with triangles");
    return sampler;
}

void SurfaceSampler::visit(const Request& request,
                           const std::function<void(const SurfaceSample&)>& visit) const {
    const double per_sample = area() / static_cast<double>(request.count);
    const auto area_at = [&](std::uint64_t sample) {
        return (static_cast<double>(sample) + uniform(request.seed, sample, 0)) * per_sample;
    };
    if (request.begin >= request.end)
        return;
    const auto after =
        std::upper_bound(area_before_.begin(), area_before_.end(), area_at(request.begin));
    const auto found = static_cast<std::size_t>(after - area_before_.begin());
    std::uint64_t sample = request.begin;
    for (std::size_t i = std::min(found, patches_.size()) - 1; i < patches_.size(); ++i) {
        const Patch& patch = patches_[i];
        const SurfacePiece& piece = pieces_[patch.piece];
        double reached = area_before_[i];
        for (std::size_t t = patch.first_triangle; t < patch.last_triangle; ++t) {
            const Triangle triangle = piece.triangle(t);
            reached += areaOf(triangle);
            for (; sample < request.end && area_at(sample) < reached; ++sample) {
                const glm::dvec3 weights =
                    weightsAt(uniform(request.seed, sample, 1), uniform(request.seed, sample, 2));
                visit({pointAt(triangle, weights), patch.piece, t, weights});
            }
            if (sample == request.end)
                return;
        }
    }
}

} // namespace lodestone
