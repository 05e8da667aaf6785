#pragma once
#include "simplify/lod_source.h"

namespace lodestone {

// The finest position of the source with at most that many triangles, instances counted; its last
// one if all have more. O(log positions) of LodSource::trianglesAt(). Any thread.
std::uint64_t finestWithin(const LodSource& source, double triangle_count);

} // namespace lodestone
