#pragma once
#include "scene/lod.h"

namespace lodestone::bench {

// Connected pieces of a LOD's surface, instances counted: triangles of a submesh that share the
// place of a corner are of one piece. O(vertices log vertices).
std::uint64_t countPieces(const Scene& scene, const Lod& lod);

} // namespace lodestone::bench
