#pragma once
#include "scene/job_context.h"
#include "scene/lod.h"
#include "scene/result.h"

namespace lodestone {

struct DistanceOptions {
    std::uint64_t samples = 300'000; // area-weighted points on each of the two surfaces, >= 1
    std::uint64_t seed = 1;
};

// In % of the diagonal of A's robust world bounds; each the larger (max, rms) or the average (mean)
// of both directions.
struct Distance {
    double hausdorff = 0.0;
    double mean = 0.0;
    double rms = 0.0;
    double a_to_b_max = 0.0;
    double a_to_b_mean = 0.0;
    double b_to_a_max = 0.0;
    double b_to_a_mean = 0.0;
    double sampled_max = 0.0;  // at the samples alone, as sampling programs print it; <= hausdorff
    std::uint64_t samples = 0; // in all
};

// A scene seen through one of its LODs.
struct LodView {
    const Scene* scene = nullptr;
    const Lod* lod = nullptr;
};

// Two-sided surface distance in world space: mean and rms from samples (Metro: Cignoni, Rocchini,
// Scopigno 1998), maxima by branch and bound. Instances are not expanded in memory. Deterministic
// for any number of threads. Errors: BadInput if a side has no triangle; Usage for options;
// Cancelled. Any thread, parallel; O((samples + instanced triangles) log triangles).
Result<Distance> measureDistance(const LodView& a,
                                 const LodView& b,
                                 const DistanceOptions& options,
                                 const JobContext& job);

} // namespace lodestone
