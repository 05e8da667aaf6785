#pragma once
// Two scenes made ready to be measured against each other.
#include "simplify/measure/closest_surface.h"
#include "simplify/measure/sample_blocks.h"
#include "simplify/measure/surface_samples.h"

namespace lodestone {

// What is measured from and to. The view's geometries must outlive it.
struct MeasuredSide {
    std::vector<SurfacePiece> pieces;
    SurfaceSampler sampler; // of pieces
    ClosestSurface surface; // of pieces
};

struct MeasuredPair {
    MeasuredSide a;
    MeasuredSide b;
};

// Both in the frame of A. Errors: Usage for options; BadInput if a side has no triangle, or A no
// extent; Cancelled. Any thread; parallel.
Result<MeasuredPair> measuredPair(const LodView& a,
                                  const LodView& b,
                                  const DistanceOptions& options,
                                  const JobContext& job);

// Sums over the samples of `from`: add(sums, sample, hit) for each, hit on `to` being closest.
// Sums as in sumBlocks. Errors: Cancelled. Parallel; the same for any number of threads.
template <class Sums, class Add>
Result<Sums> sumOverSamples(const MeasuredSide& from,
                            const MeasuredSide& to,
                            const DistanceOptions& options,
                            const JobContext& job,
                            const Add& add) {
    return sumBlocks<Sums>(
        options.samples, job, [&](std::uint64_t begin, std::uint64_t end, Sums& block) {
            ClosestSurface::Cursor cursor(to.surface);
            from.sampler.visit({begin, end, options.samples, options.seed},
                               [&](const SurfaceSample& sample) {
                                   add(block, sample, cursor.closest(sample.point));
                               });
        });
}

} // namespace lodestone
