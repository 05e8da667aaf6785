#include "simplify/measure/distance.h"

#include "simplify/measure/farthest.h"
#include "simplify/measure/measured_side.h"

#include <cmath>

namespace lodestone {

namespace {

struct Sums {
    std::uint64_t count = 0;
    double sum = 0.0;
    double sum2 = 0.0;
    double max = 0.0;

    void add(double distance) {
        ++count;
        sum += distance;
        sum2 += distance * distance;
        max = std::max(max, distance);
    }

    void add(const Sums& other) {
        count += other.count;
        sum += other.sum;
        sum2 += other.sum2;
        max = std::max(max, other.max);
    }

    double mean() const { return sum / static_cast<double>(count); }

    double rms() const { return std::sqrt(sum2 / static_cast<double>(count)); }
};

struct OneSided {
    Sums samples;
    double max = 0.0;
};

Result<OneSided> measureOneSided(const MeasuredSide& from,
                                 const MeasuredSide& to,
                                 const DistanceOptions& options,
                                 const JobContext& job) {
    const auto add = [](Sums& sums, const SurfaceSample&, const ClosestSurface::Hit& hit) {
        sums.add(hit.distance);
    };
    const Result<Sums> sums = sumOverSamples<Sums>(from, to, options, partOf(job, 0.0, 0.5), add);
    if (!sums)
        return tl::unexpected(sums.error());
    const Result<double> farthest =
        farthestDistance(from.pieces, to.surface, sums->max, partOf(job, 0.5, 1.0));
    if (!farthest)
        return tl::unexpected(farthest.error());
    return OneSided{*sums, *farthest};
}

} // namespace

Result<Distance> measureDistance(const LodView& a,
                                 const LodView& b,
                                 const DistanceOptions& options,
                                 const JobContext& job) {
    const Result<MeasuredPair> pair = measuredPair(a, b, options, job);
    if (!pair)
        return tl::unexpected(pair.error());
    const Result<OneSided> a_to_b =
        measureOneSided(pair->a, pair->b, options, partOf(job, 0.2, 0.6));
    if (!a_to_b)
        return tl::unexpected(a_to_b.error());
    const Result<OneSided> b_to_a =
        measureOneSided(pair->b, pair->a, options, partOf(job, 0.6, 1.0));
    if (!b_to_a)
        return tl::unexpected(b_to_a.error());

    const auto percent = [](double diagonals) { return 100.0 * diagonals; };
    Distance distance;
    distance.a_to_b_max = percent(a_to_b->max);
    distance.b_to_a_max = percent(b_to_a->max);
    distance.a_to_b_mean = percent(a_to_b->samples.mean());
    distance.b_to_a_mean = percent(b_to_a->samples.mean());
    distance.hausdorff = std::max(distance.a_to_b_max, distance.b_to_a_max);
    distance.sampled_max = percent(std::max(a_to_b->samples.max, b_to_a->samples.max));
    distance.mean = 0.5 * (distance.a_to_b_mean + distance.b_to_a_mean);
    distance.rms = percent(std::max(a_to_b->samples.rms(), b_to_a->samples.rms()));
    distance.samples = a_to_b->samples.count + b_to_a->samples.count;
    return distance;
}

} // namespace lodestone
