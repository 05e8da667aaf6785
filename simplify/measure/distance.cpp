#include "simplify/measure/distance.h"

#include "simplify/measure/closest_surface.h"
#include "simplify/measure/surface_samples.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// Small enough to be cancelled within 10 ms, large enough that a block's points lie together.
constexpr std::uint64_t kBlockPoints = 256;

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
};

// Where a stage lies on the progress bar.
struct Stage {
    double begin = 0.0;
    double end = 1.0;
};

// Sums of measure_block(begin, end, sums) over [0, count), added up in order.
template <class MeasureBlock>
Result<Sums> sumBlocks(std::uint64_t count,
                       const Stage& stage,
                       const JobContext& job,
                       const MeasureBlock& measure_block) {
    const std::uint64_t block_count = (count + kBlockPoints - 1) / kBlockPoints;
    constexpr std::uint64_t kBatchBlocks = 1024; // what is held at a time
    std::vector<Sums> blocks;
    Sums total;
    for (std::uint64_t first = 0; first < block_count; first += kBatchBlocks) {
        blocks.assign(std::min(kBatchBlocks, block_count - first), Sums{});
        tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
            const std::uint64_t begin = (first + i) * kBlockPoints;
            if (!job.stopRequested())
                measure_block(begin, std::min(begin + kBlockPoints, count), blocks[i]);
        });
        if (job.stopRequested())
            return cancelled();
        for (const Sums& block : blocks)
            total.add(block);
        job.report(stage.begin + (stage.end - stage.begin) *
                                     static_cast<double>(first + blocks.size()) /
                                     static_cast<double>(block_count));
    }
    return total;
}

// What is measured from and to.
struct Side {
    std::vector<SurfacePiece> pieces;
    SurfaceSampler sampler;
    ClosestSurface surface;
};

Result<Side> prepare(const LodView& view, const SurfaceFrame& frame, const JobContext& job) {
    std::vector<SurfacePiece> pieces = surfacePieces(view, frame);
    if (pieces.empty())
        return badInput(view.scene->name +
                        ": no triangle to measure; choose a scene with triangles");
    Result<SurfaceSampler> sampler = SurfaceSampler::build(pieces, job);
    if (!sampler)
        return tl::unexpected(sampler.error());
    Result<ClosestSurface> surface = ClosestSurface::build(pieces, job);
    if (!surface)
        return tl::unexpected(surface.error());
    return Side{std::move(pieces), std::move(*sampler), std::move(*surface)};
}

// Distances of `from`'s samples to `to`; `from`'s vertices join in for the maximum.
Result<Sums> measureOneSided(const Side& from,
                             const ClosestSurface& to,
                             const DistanceOptions& options,
                             const Stage& stage,
                             const JobContext& job) {
    const double middle = 0.5 * (stage.begin + stage.end);
    Result<Sums> sums = sumBlocks(
        options.samples,
        {stage.begin, middle},
        job,
        [&](std::uint64_t begin, std::uint64_t end, Sums& block) {
            ClosestSurface::Cursor cursor(to);
            from.sampler.visit({begin, end, options.samples, options.seed},
                               [&](const glm::dvec3& point) { block.add(cursor.distance(point)); });
        });
    if (!sums)
        return sums;
    const SurfaceVertices vertices(from.pieces);
    const std::uint64_t step = (vertices.size() + options.samples - 1) / options.samples;
    Result<Sums> at_vertices = sumBlocks((vertices.size() + step - 1) / step,
                                         {middle, stage.end},
                                         job,
                                         [&](std::uint64_t begin, std::uint64_t end, Sums& block) {
                                             ClosestSurface::Cursor cursor(to);
                                             for (std::uint64_t v = begin; v < end; ++v) {
                                                 const glm::dvec3 point = vertices.at(v * step);
                                                 if (!isFar(point))
                                                     block.add(cursor.distance(point));
                                             }
                                         });
    if (!at_vertices)
        return at_vertices;
    sums->max = std::max(sums->max, at_vertices->max);
    return sums;
}

} // namespace

Result<Distance> measureDistance(const LodView& a,
                                 const LodView& b,
                                 const DistanceOptions& options,
                                 const JobContext& job) {
    if (options.samples < 1)
        return fail(ErrorKind::Usage, "distance: the number of samples must be 1 or more");
    const Result<SurfaceFrame> frame = frameOf(*a.scene);
    if (!frame)
        return tl::unexpected(frame.error());
    const Result<Side> side_a = prepare(a, *frame, job);
    if (!side_a)
        return tl::unexpected(side_a.error());
    const Result<Side> side_b = prepare(b, *frame, job);
    if (!side_b)
        return tl::unexpected(side_b.error());
    const Result<Sums> a_to_b = measureOneSided(*side_a, side_b->surface, options, {0.2, 0.6}, job);
    if (!a_to_b)
        return tl::unexpected(a_to_b.error());
    const Result<Sums> b_to_a = measureOneSided(*side_b, side_a->surface, options, {0.6, 1.0}, job);
    if (!b_to_a)
        return tl::unexpected(b_to_a.error());

    const auto percent = [](double diagonals) { return 100.0 * diagonals; };
    const auto mean = [](const Sums& s) { return s.sum / static_cast<double>(s.count); };
    const auto rms = [](const Sums& s) { return std::sqrt(s.sum2 / static_cast<double>(s.count)); };
    Distance distance;
    distance.a_to_b_max = percent(a_to_b->max);
    distance.b_to_a_max = percent(b_to_a->max);
    distance.a_to_b_mean = percent(mean(*a_to_b));
    distance.b_to_a_mean = percent(mean(*b_to_a));
    distance.hausdorff = std::max(distance.a_to_b_max, distance.b_to_a_max);
    distance.mean = 0.5 * (distance.a_to_b_mean + distance.b_to_a_mean);
    distance.rms = percent(std::max(rms(*a_to_b), rms(*b_to_a)));
    distance.samples = a_to_b->count + b_to_a->count;
    return distance;
}

} // namespace lodestone
