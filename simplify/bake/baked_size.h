#pragma once
// The size of a file whose textures are still to be transferred.
#include "scene/lod.h"
#include "simplify/bake/bake_options.h"

namespace lodestone {

// About the bytes of a LOD's file once its textures are transferred, so that a size can be shown
// while that is done; what images compress to is a guess, mostly right within a factor of two.
// lod: of the scene; kept_bytes: its file with the textures that it has. O(primitives).
std::uint64_t estimateBakedBytes(const Scene& scene,
                                 const Lod& lod,
                                 const BakeOptions& options,
                                 std::uint64_t kept_bytes);

} // namespace lodestone
