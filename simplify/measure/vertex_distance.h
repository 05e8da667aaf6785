#pragma once
// How far each vertex of a LOD is from another surface: what a heat map shows.
#include "simplify/measure/distance.h"

namespace lodestone {

// Over the kept instances of a submesh, in % of the diagonal of the reference's robust world
// bounds; 0 for vertices that no triangle uses.
struct VertexDistances {
    std::vector<float> max;  // [vertices of the primitive's geometry]
    std::vector<float> mean; // likewise
};

// [submeshes][primitives] of the view's scene; empty vectors for primitives without triangles.
using VertexDistanceField = std::vector<std::vector<VertexDistances>>;

struct VertexDistanceOptions {
    // Submeshes with many instances are measured at every second, third, ... one, so that not much
    // more than this many points are measured in all; every submesh has one instance measured.
    std::uint64_t points = 4'000'000; // >= 1
};

// World distance from the vertices of `view` to the surface of `reference`; for the other way round
// swap them (percentages are then of the other's diagonal). Deterministic for any number of
// threads. Errors as measureDistance. Any thread, parallel; O(points log triangles).
Result<VertexDistanceField> measureVertexDistances(const LodView& view,
                                                   const LodView& reference,
                                                   const VertexDistanceOptions& options,
                                                   const JobContext& job);

} // namespace lodestone
