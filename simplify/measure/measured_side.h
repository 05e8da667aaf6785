#pragma once
// Two scenes made ready to be measured against each other.
#include "simplify/measure/closest_surface.h"
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

} // namespace lodestone
