#pragma once
// Texture transfer: a LOD's own textures, made from what the original surface looks like.
#include "scene/lod.h"
#include "simplify/bake/bake_options.h"
#include "simplify/bake/baked_scene.h"
#include "simplify/collapse/sequence.h"

namespace lodestone {

// One submesh of a LOD: where it stands in its sequence.
struct BakeSubmesh {
    const CollapseSequence* sequence = nullptr;
    std::uint32_t step = 0;
    double growth = 1.0; // of its vertices about the pivot
    glm::dvec3 pivot{0.0};
    double stretch = 1.0; // largest factor of its instances on lengths: texels follow world size
};

// Whether a transfer gives a primitive of the scene new textures: it has some, or vertex colours.
bool isBaked(const Scene& scene, const Primitive& primitive);

// Makes a scene of a LOD with new texture coordinates (every triangle by itself) and new images:
// base colour, and where the materials have them normals (in the new tangent frame), occlusion,
// roughness, metalness and emission. Vertex colours go into the base colour. Each texel's point is
// traced back to the original surface (SuccessiveMap). Primitives without texture and vertex
// colours stay as the LOD has them, and so do, textures and all, materials that keep_better lets
// keep theirs; a note names those. Instances stay instances; animations and skins are left out.
// submeshes, lod: of the scene. Parallel over triangles, the same for any number of threads.
// Errors: Usage if an atlas is too small for its triangles; Cancelled; Failed (memory). Any thread.
// O(texels * splits a point crosses). Source: Wild (Liu et al. 2024), section 7.
Result<BakedScene> bakeTextures(const Scene& scene,
                                const Lod& lod,
                                std::span<const BakeSubmesh> submeshes,
                                const BakeOptions& options,
                                const JobContext& job);

} // namespace lodestone
