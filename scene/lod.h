#pragma once
// What a LOD of a scene is, and its shape (counts only), which is all that size prediction needs.
#include "scene/scene.h"

namespace lodestone {

struct LodSubmesh {
    std::vector<GeometryPtr> primitives; // [submesh.primitives]; the scene's own where unchanged
    // Kept instances, indices into Scene::instances in storage order: the order in which they
    // survive longest, so that a coarser LOD keeps a prefix. Null: all, in the scene's order.
    std::shared_ptr<const std::vector<std::uint32_t>> instance_order;
    std::uint32_t kept_instances = 0; // the first that many of instance_order
};

// A level of detail: geometry per submesh plus a prefix of its instances. Transforms never change.
struct Lod {
    std::vector<LodSubmesh> submeshes; // [scene.submeshes]
    std::uint64_t triangles = 0;       // kept instances counted
    std::uint64_t unique_triangles = 0;
    std::uint64_t instances = 0;
    std::uint64_t position = 0; // step of the schedule it was read out at
};

// The scene itself as a LOD: every pointer is the scene's own.
Lod fullLod(const Scene& scene);

struct PrimitiveShape {
    std::uint32_t vertices = 0;
    std::uint32_t indices = 0;
};

// Counts of a LOD. Cheap to compute for any position of a schedule without reading out meshes.
struct LodShape {
    struct SubmeshShape {
        std::vector<PrimitiveShape> primitives; // [submesh.primitives]
        std::uint32_t kept_instances = 0;
        bool changed = false; // some primitive differs from the scene's own
        std::shared_ptr<const std::vector<std::uint32_t>> instance_order; // as in LodSubmesh
    };

    std::vector<SubmeshShape> submeshes;
};

LodShape shapeOf(const Scene& scene, const Lod& lod);

} // namespace lodestone
