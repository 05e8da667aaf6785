#include "simplify/measure/color_distance.h"

#include "simplify/measure/colored_side.h"

#include <optional>

namespace lodestone {

namespace {

Result<ColorSums> measureOneSided(const ColoredSide& from,
                                  const ColoredSide& to,
                                  const DistanceOptions& options,
                                  const JobContext& job) {
    const auto add =
        [&](ColorSums& sums, const SurfaceSample& sample, const ClosestSurface::Hit& hit) {
            const glm::dvec3 here = from.colorAt(sample.piece, sample.triangle, sample.weights);
            const glm::dvec3 there = to.colorAt(hit, sample.point);
            sums.add(here - there);
        };
    return sumOverSamples<ColorSums>(from.side, to.side, options, job, add);
}

} // namespace

Result<ColorDistance> measureColorDistance(const LodView& a,
                                           const LodView& b,
                                           const DistanceOptions& options,
                                           const JobContext& job) {
    const Result<MeasuredPair> pair = measuredPair(a, b, options, job);
    if (!pair)
        return tl::unexpected(pair.error());
    const SurfaceColors colors_a(*a.scene);
    std::optional<SurfaceColors> own_colors_b; // the same scene's images are decoded once
    if (b.scene != a.scene)
        own_colors_b.emplace(*b.scene);
    const SurfaceColors& colors_b = own_colors_b ? *own_colors_b : colors_a;
    const ColoredSide side_a{pair->a, colors_a};
    const ColoredSide side_b{pair->b, colors_b};
    const Result<ColorSums> a_to_b =
        measureOneSided(side_a, side_b, options, partOf(job, 0.2, 0.6));
    if (!a_to_b)
        return tl::unexpected(a_to_b.error());
    const Result<ColorSums> b_to_a =
        measureOneSided(side_b, side_a, options, partOf(job, 0.6, 1.0));
    if (!b_to_a)
        return tl::unexpected(b_to_a.error());
    ColorDistance distance;
    distance.a_to_b = a_to_b->mean();
    distance.b_to_a = b_to_a->mean();
    distance.mean = 0.5 * (distance.a_to_b + distance.b_to_a);
    distance.samples = a_to_b->count + b_to_a->count;
    distance.notes = colors_a.notes();
    if (own_colors_b)
        distance.notes.insert(
            distance.notes.end(), colors_b.notes().begin(), colors_b.notes().end());
    return distance;
}

} // namespace lodestone
