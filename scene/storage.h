#pragma once
// The ways an export can store a scene's instances, of which it takes the smallest. Internal to
// scene/: ByteModel and exportScene() are the public faces.
#include "scene/expansion.h"
#include "scene/gltf/writer.h"

namespace lodestone {

// One way: which submeshes are expanded and merged, and the plan of the scene that this gives.
struct Storage {
    std::optional<Expansion> expansion; // none: every submesh keeps its instances
    std::unique_ptr<const ExportPlan> plan;
    std::vector<bool> expanded; // [submeshes]; empty without an expansion

    // The scene that is written: the given one, or the skeleton of the expanded one.
    const Scene& writtenScene() const { return plan->scene; }
};

// Counts of a LOD in the scene that a way writes, where everything lies, and what that weighs.
struct StoredShape {
    LodShape shape;
    Layout layout;
    std::uint64_t bytes = 0;
};

// The way of the options; Expand: all that can merge is merged. scene must outlive it.
Storage planStorage(const Scene& scene, const ExportOptions& options);
// Further ways for Instancing::Auto, in which submeshes that are small against their transforms
// and JSON are expanded: few, nested, from those worth it in full detail to all. They are the same
// for every LOD and each falls with every step, so that the smallest falls, too. None where sizes
// are only estimated, or where nothing would merge.
// first: as by planStorage(). O(storages * (instances + document)), parallel.
std::vector<Storage> planExpandedStorages(const Scene& scene, const Storage& first);

// O(kept instances + primitives + written nodes).
StoredShape storedShape(const Storage& storage, const Scene& scene, const LodShape& shape);

// Whether a LOD may be stored expanded: something of it has changed. An untouched scene keeps its
// meshes, nodes and names.
bool mayExpand(const LodShape& shape);

// The smallest of several ways; equal: the first. storages: at least one; the first alone unless
// mayExpand(shape).
struct ChosenStorage {
    std::size_t storage = 0;
    StoredShape stored;
};

ChosenStorage
smallestStorage(std::span<const Storage> storages, const Scene& scene, const LodShape& shape);

} // namespace lodestone
