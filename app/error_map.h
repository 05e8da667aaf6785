#pragma once
// How far each vertex of a lane is from the original, ready to be drawn.
#include "scene/job_context.h"
#include "scene/lod.h"
#include "scene/result.h"

namespace lodestone {

struct Document;

struct ErrorMap {
    std::shared_ptr<const Lod> lod; // its geometries carry kVertexValueSemantic, % of the diagonal
    double peak = 0.0; // % of the diagonal; all vertices but one in two hundred are below
    std::uint64_t lod_revision = 0; // of the lane's LOD that it was made of; 0: none
};

// Both distances of a scene seen through its LODs: see measureVertexDistances.
struct ErrorMapInput {
    ScenePtr original;
    ScenePtr scene; // whose submeshes `lod` replaces
    std::shared_ptr<const Lod> lod;
};

// The same LOD with distances at its vertices. The original itself is 0 everywhere, at once.
// Errors: as measureVertexDistances. Any thread; O(points log triangles), four million points.
Result<ErrorMap> makeErrorMap(const ErrorMapInput& input, const JobContext& job);

// What the last colour stands for, the same in all lanes: 1, 2 or 5 times a power of ten, above the
// peaks. % of the diagonal, > 0.
double errorMapFull(const Document& document);

} // namespace lodestone
