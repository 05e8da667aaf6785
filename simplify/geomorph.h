#pragma once
// Geomorphs (Hoppe 1996): vertices slide from where a LOD has them to where a coarser one does.
#include "scene/lod.h"

namespace lodestone {

struct Geomorph {
    Lod fine; // the whole way has its triangles and instances
    // [submeshes][primitives] the fine geometry's vertices where the coarser LOD has them, without
    // indices. Empty: the submesh stays as it is.
    std::vector<std::vector<GeometryPtr>> ends;
};

// The LOD at a share of the way, 0..1. At 0 it is the fine one; at 1 its surface is the coarser
// one's, and triangles that one has not are degenerate. Floating-point attributes slide along, all
// others stay the fine LOD's. Submeshes without ends share the fine geometry.
// Any thread; parallel, the same on any number of threads. O(vertices and indices with ends).
Lod slid(const Geomorph& geomorph, double share);

// What a LodSource is, too, if its LODs have vertices in common.
class GeomorphSource {
public:
    GeomorphSource() = default;
    GeomorphSource(const GeomorphSource&) = delete;
    GeomorphSource& operator=(const GeomorphSource&) = delete;
    virtual ~GeomorphSource() = default;

    // From one position of the source to another, fine <= coarse. Any thread; costs two read-outs.
    virtual Geomorph geomorph(std::uint64_t fine, std::uint64_t coarse) const = 0;
};

} // namespace lodestone
