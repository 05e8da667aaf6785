#pragma once
// Debian's meshoptimizer, as a user would call it.
#include "bench/peers/peer.h"
#include "scene/lod.h"

namespace lodestone::bench {

std::string meshoptimizerName(); // with its version

// The indices of `ratio` of a geometry's triangles, or of as many as it gets stuck at. No limit on
// the error. geometry: a triangle list.
std::vector<std::uint32_t> meshoptimizerSimplify(const Geometry& geometry, double ratio);

// Equal positions made one vertex; no attributes.
Geometry weldPositions(const Geometry& geometry);

// Every mesh by the same ratio, whatever its instances; all instances are kept.
Lod simplifyEachMesh(const Scene& scene, double ratio, Welding welding);

// The only primitive of a scene of one mesh as a LOD of that many indices.
Lod lodOfIndices(const Scene& scene, const Geometry& vertices, std::vector<std::uint32_t> indices);

} // namespace lodestone::bench
