#pragma once
// What a LOD is worth.
#include "simplify/lod_source.h"
#include "simplify/measure/distance.h"

namespace lodestone::bench {

// 300,000 samples a side, against the full scene.
Result<Distance> distanceToFull(const LodView& lod);

// The largest distance of up to 300,000 vertices, of the LOD from the full scene or the other way
// round; % of the diagonal.
Result<double> farthestVertex(const LodView& lod);

// World area of a LOD over that of the full scene.
Result<double> areaLeft(const LodView& lod);

// The LOD of a source at a target of instanced triangles.
Lod lodAtTriangles(const LodSource& source, double triangles);

// Whether nothing was lost that must not be.
struct Losses {
    std::uint32_t vanished_submeshes = 0; // drawn in the scene, not in the LOD
    // Instances removed from submeshes that collapses could still reduce.
    std::uint64_t early_instances = 0;
};

// floors: the triangles of each submesh that collapses alone can reach.
Losses lossesOf(const Scene& scene, const Lod& lod, std::span<const std::uint64_t> floors);

std::vector<std::uint64_t> trianglesBySubmesh(const Lod& lod); // each once

} // namespace lodestone::bench
