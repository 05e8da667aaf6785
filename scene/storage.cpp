#include "scene/storage.h"

#include <algorithm>
#include <map>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// Copies of the source document with all its buffers may take that much.
constexpr std::uint64_t kMostCopiedBytes = std::uint64_t{1} << 28;

Storage makeStorage(const Scene& scene, const ExportOptions& options, std::vector<bool> expanded) {
    Storage storage;
    storage.expanded = std::move(expanded);
    const bool merges = std::ranges::find(storage.expanded, true) != storage.expanded.end();
    if (merges)
        storage.expansion = planExpansion(scene, storage.expanded);
    const Scene& written = merges ? *storage.expansion->skeleton : scene;
    // Vertices of an expanded scene are only known by their bounds.
    const Bounds merged =
        merges && options.compression != Compression::None ? worldBounds(scene) : Bounds{};
    storage.plan = std::make_unique<const ExportPlan>(
        written, options, planGrids(written, options.compression, submeshBounds(written, merged)));
    return storage;
}

// What decides whether a submesh is worth expanding, estimated from the plan that keeps it.
class ExpansionGain {
public:
    ExpansionGain(const ExportPlan& plan, std::size_t submesh)
        : submesh_(plan.submeshes[submesh]), instances_(submesh_.range.size()) {
        const MeshPlan& mesh = plan.meshes[submesh_.mesh];
        json_bytes_ = kMeshBytes;
        for (const PrimitivePlan& primitive : mesh.primitives) {
            double vertex_bytes = 0.0;
            for (const StreamPlan& stream : primitive.streams)
                vertex_bytes += plan.strides[stream.view_class - kFirstStrideClass];
            const double index_bytes = primitive.full.vertices > 65535 ? 4.0 : 2.0;
            geometry_bytes_ +=
                vertex_bytes * primitive.full.vertices + index_bytes * primitive.full.indices;
            floor_bytes_ += vertex_bytes * std::min(kFloorVertices, primitive.full.vertices) +
                            index_bytes * std::min(kFloorIndices, primitive.full.indices);
            json_bytes_ +=
                kAccessorBytes * static_cast<double>(primitive.streams.size() + 1) + kBoundsBytes;
        }
    }

    // Bytes saved, at that share of the triangles, by storing every instance's own vertices.
    double at(double share) const {
        if (instances_ == 0)
            return 0.0;
        const double geometry = std::max(share * geometry_bytes_, floor_bytes_);
        return json_bytes_ + transformBytes() - (instances_ - 1.0) * geometry;
    }

private:
    double transformBytes() const {
        return instances_ >= submesh_.fold_from
                   ? submesh_.fold_fixed_bytes + instances_ * submesh_.row_bytes
                   : instances_ * submesh_.node_bytes;
    }

    static constexpr double kMeshBytes = 60.0;
    static constexpr double kAccessorBytes = 100.0;
    static constexpr double kBoundsBytes = 90.0; // min and max of the positions
    static constexpr std::uint32_t kFloorVertices = 6;
    static constexpr std::uint32_t kFloorIndices = 12;

    const SubmeshPlan& submesh_;
    double instances_;
    double json_bytes_ = 0.0;
    double geometry_bytes_ = 0.0;
    double floor_bytes_ = 0.0;
};

// Takes out what would have nothing to merge with: the only instance of its materials.
void dropLoners(std::vector<bool>& set, const Scene& scene, const ExportPlan& plan) {
    std::map<std::uint32_t, std::uint64_t> drawn; // of each material
    for (std::size_t s = 0; s < set.size(); ++s)
        if (set[s])
            for (const Primitive& primitive : scene.submeshes[s].primitives)
                drawn[primitive.material] += plan.submeshes[s].range.size();
    for (std::size_t s = 0; s < set.size(); ++s)
        if (set[s] &&
            std::ranges::all_of(scene.submeshes[s].primitives, [&](const auto& primitive) {
                return drawn[primitive.material] < 2;
            }))
            set[s] = false;
}

// Nested sets of submeshes to expand, the smallest first, no two alike; the last: all that merge.
std::vector<std::vector<bool>> setsToExpand(const Scene& scene, const ExportPlan& plan) {
    const std::vector<bool> merging = mergingSubmeshes(scene);
    std::vector<std::vector<bool>> sets;
    const auto add = [&](const auto& wants) {
        std::vector<bool> set(merging.size(), false);
        for (std::size_t s = 0; s < set.size(); ++s)
            set[s] = merging[s] && plan.submeshes[s].range.size() > 0 && wants(s);
        dropLoners(set, scene, plan);
        const bool any = std::ranges::find(set, true) != set.end();
        if (any && (sets.empty() || sets.back() != set))
            sets.push_back(std::move(set));
    };
    for (const double share : {1.0, 0.25, 0.06, 0.0})
        add([&](std::size_t s) { return ExpansionGain(plan, s).at(share) > 0.0; });
    add([](std::size_t) { return true; });
    return sets;
}

std::uint64_t bufferBytes(const Scene& scene) {
    std::uint64_t bytes = 0;
    for (const std::vector<std::byte>& buffer : scene.source->buffers)
        bytes += buffer.size();
    return bytes;
}

} // namespace

Storage planStorage(const Scene& scene, const ExportOptions& options) {
    return makeStorage(
        scene,
        options,
        std::vector<bool>(scene.submeshes.size(), options.instancing == Instancing::Expand));
}

std::vector<Storage> planExpandedStorages(const Scene& scene, const Storage& first) {
    const ExportOptions& options = first.plan->options;
    if (options.instancing != Instancing::Auto || isPacked(options))
        return {};
    std::vector<std::vector<bool>> sets = setsToExpand(scene, *first.plan);
    if (sets.size() * bufferBytes(scene) > kMostCopiedBytes)
        return {};
    std::vector<Storage> storages(sets.size());
    tbb::parallel_for(std::size_t{0}, sets.size(), [&](std::size_t i) {
        storages[i] = makeStorage(scene, options, std::move(sets[i]));
    });
    return storages;
}

StoredShape storedShape(const Storage& storage, const Scene& scene, const LodShape& shape) {
    StoredShape stored;
    stored.shape = storage.expansion ? expandShape(*storage.expansion, scene, shape) : shape;
    stored.layout = chooseLayout(*storage.plan, stored.shape);
    stored.bytes = exportedBytes(*storage.plan, stored.layout);
    return stored;
}

bool mayExpand(const LodShape& shape) {
    return std::ranges::any_of(shape.submeshes, &LodShape::SubmeshShape::changed);
}

ChosenStorage
smallestStorage(std::span<const Storage> storages, const Scene& scene, const LodShape& shape) {
    ChosenStorage chosen{0, storedShape(storages.front(), scene, shape)};
    if (!mayExpand(shape))
        return chosen;
    for (std::size_t i = 1; i < storages.size(); ++i) {
        StoredShape stored = storedShape(storages[i], scene, shape);
        if (stored.bytes < chosen.stored.bytes)
            chosen = {i, std::move(stored)};
    }
    return chosen;
}

} // namespace lodestone
