#pragma once
// The ways an export can store a scene's instances, of which it takes the smallest. Internal to
// scene/: ByteModel and exportScene() are the public faces.
#include "scene/expansion.h"
#include "scene/gltf/writer.h"

namespace lodestone {

// Counts of a LOD in the scene that is written, where everything lies, and what that weighs.
struct StoredShape {
    std::size_t way = 0; // of StoragePlan
    LodShape shape;
    Layout layout;
    std::uint64_t bytes = 0;
};

// One plan for all ways in which the LODs of a scene can be stored. Read by any number of threads.
//
// Instancing::Auto has several ways, in which submeshes that are small against their transforms and
// JSON are expanded and merged: nested sets, from none to all. They are the same for every LOD and
// each falls with every step, so that the smallest falls, too. One way alone where sizes are only
// estimated, or where nothing merges.
class StoragePlan {
public:
    // scene must outlive it. O(instances + document).
    StoragePlan(const Scene& scene, const ExportOptions& options);

    const ExportPlan& plan() const { return *plan_; }

    // Of the scene that is written; what is merged there is bounded by the whole scene.
    // [plan().scene.submeshes]
    const std::vector<Bounds>& bounds() const { return bounds_; }

    // Instancing::Expand: what is written instead of the scene; otherwise null.
    const Expansion* replacement() const;

    // Submeshes of the scene that a way expands. [scene.submeshes]
    const std::vector<bool>& expanded(std::size_t way) const { return ways_[way]; }

    // The smallest way to store a LOD; equal: the one that expands less. A LOD in which nothing has
    // changed is not expanded: an untouched scene keeps its meshes, nodes and names.
    // O(ways * (kept instances + primitives + nodes)).
    StoredShape smallest(const LodShape& shape) const;

    // A LOD of the scene as one of the scene that is written. Errors: as expandLod().
    Result<Lod> storedLod(const Lod& lod, std::size_t way) const;

private:
    void planWays(const std::vector<bool>& merging);
    std::uint64_t mergedBytes(const LodShape& shape, std::size_t submesh) const;
    LodShape shapeIn(const LodShape& shape, std::size_t way) const;
    StoredShape stored(const LodShape& shape, std::size_t way) const;

    const Scene& scene_;
    std::optional<Expansion> expansion_; // none: the scene is written as it is
    std::vector<Bounds> bounds_;
    std::unique_ptr<const ExportPlan> plan_;
    std::vector<std::vector<bool>> ways_; // what each expands, beside what came before
};

} // namespace lodestone
