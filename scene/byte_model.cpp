#include "scene/export.h"
#include "scene/gltf/packed_export.h"
#include "scene/gltf/packed_size.h"
#include "scene/storage.h"

#include <optional>

namespace lodestone {

struct ByteModel::Impl {
    Impl(ScenePtr from, const ExportOptions& options)
        : scene(std::move(from)), storage(*scene, options), ranges(instanceRanges(*scene)) {
        if (expansion())
            findMergedParts();
        if (isPacked(options))
            learnPacking();
    }

    const ExportPlan& plan() const { return storage.plan(); }

    const Expansion* expansion() const { return storage.replacement(); }

    void learnPacking() {
        packing.emplace();
        for (const double share : {1.0, 0.25, 0.06, 0.015}) {
            Lod lod = sampleLod(*scene, share);
            LodShape shape = shapeOf(*scene, lod);
            if (expansion()) {
                Result<Lod> expanded = expandLod(*expansion(), *scene, lod, {});
                if (!expanded)
                    continue; // more vertices than fit: a smaller share may
                shape = expandShape(*expansion(), *scene, shape);
                lod = std::move(*expanded);
            }
            const Layout layout = chooseLayout(plan(), shape);
            const Result<PackedDocument> packed = packedExport(plan(), layout, lod, "");
            if (!packed)
                continue; // positions that are not finite
            const ExportBytes unpacked = exportBytes(plan(), layout);
            packing->learn(unpacked, packedBytes(*packed, dumpJson(packed->json).size(), unpacked));
        }
    }

    std::uint64_t bytesOf(const LodShape& shape) const {
        const StoredShape stored = storage.smallest(shape);
        if (!packing)
            return stored.bytes;
        return static_cast<std::uint64_t>(packing->estimate(exportBytes(plan(), stored.layout)));
    }

    double packed(ExportBytes::Part part, double bytes) const {
        return packing ? bytes * packing->ratio(part) : bytes;
    }

    void findMergedParts() {
        merged_part.resize(scene->submeshes.size());
        merging_instances.assign(scene->submeshes.size(), 0);
        for (std::size_t s = 0; s < scene->submeshes.size(); ++s)
            merged_part[s].resize(scene->submeshes[s].primitives.size(), kNone);
        for (std::uint32_t g = 0; g < expansion()->groups.size(); ++g)
            for (const ExpandPart& part : expansion()->groups[g].parts)
                merged_part[part.submesh][part.primitive] = expansion()->first_merged + g;
        for (std::size_t i = 0; i < scene->instances.size(); ++i)
            merging_instances[scene->instances[i].submesh] += expansion()->merges[i] ? 1 : 0;
        apart_of.assign(scene->submeshes.size(), kNone);
        for (std::uint32_t s = 0; s < expansion()->apart.size(); ++s)
            apart_of[expansion()->apart[s]] = s;
    }

    // Bytes of a vertex and of a triangle as one primitive of the plan's scene stores them.
    double vertexBytes(std::uint32_t submesh, std::uint32_t primitive) const {
        double bytes = 0.0;
        const MeshPlan& mesh = plan().meshes[plan().submeshes[submesh].mesh];
        for (const StreamPlan& stream : mesh.primitives[primitive].streams)
            bytes += plan().strides[stream.view_class - kFirstStrideClass];
        return packed(ExportBytes::Geometry, bytes);
    }

    // How often a vertex of the scene's primitive is written, and as part of what.
    struct Copies {
        double merged = 0.0;
        double apart = 0.0; // 0 or 1
    };

    Copies copies(std::uint32_t submesh) const {
        return {static_cast<double>(merging_instances[submesh]),
                apart_of[submesh] != kNone ? 1.0 : 0.0};
    }

    ScenePtr scene;
    StoragePlan storage;
    std::optional<PackedSizes> packing; // Meshopt and Draco
    std::vector<InstanceRange> ranges;
    std::vector<std::vector<std::uint32_t>> merged_part; // [submeshes][primitives] in the skeleton
    std::vector<std::uint64_t> merging_instances;        // [submeshes]
    std::vector<std::uint32_t> apart_of;                 // [submeshes] in the skeleton, or kNone
};

ByteModel::ByteModel(ScenePtr scene, const ExportOptions& options)
    : impl_(std::make_unique<Impl>(std::move(scene), options)) {}

ByteModel::~ByteModel() = default;
ByteModel::ByteModel(ByteModel&&) noexcept = default;
ByteModel& ByteModel::operator=(ByteModel&&) noexcept = default;

std::uint64_t ByteModel::bytes(const LodShape& shape) const {
    return impl_->bytesOf(shape);
}

double ByteModel::bytesPerVertex(std::uint32_t submesh, std::uint32_t primitive) const {
    if (!impl_->expansion())
        return impl_->vertexBytes(submesh, primitive);
    const Impl::Copies copies = impl_->copies(submesh);
    double bytes = 0.0;
    if (copies.merged > 0.0)
        bytes += copies.merged * impl_->vertexBytes(impl_->merged_part[submesh][primitive], 0);
    if (copies.apart > 0.0)
        bytes += impl_->vertexBytes(impl_->apart_of[submesh], primitive);
    return bytes;
}

double ByteModel::bytesPerTriangle(std::uint32_t submesh, std::uint32_t primitive) const {
    const double wide = impl_->packed(ExportBytes::Geometry, 12.0); // three 32-bit indices
    const double narrow = 0.5 * wide;
    const Geometry& geometry = *impl_->scene->submeshes[submesh].primitives[primitive].geometry;
    const double own = geometry.positions.size() > 65535 ? wide : narrow;
    if (!impl_->expansion())
        return own;
    const Impl::Copies copies = impl_->copies(submesh);
    return copies.merged * wide + copies.apart * own;
}

double ByteModel::bytesPerInstance(std::uint32_t submesh) const {
    if (!impl_->expansion()) {
        const SubmeshPlan& plan = impl_->plan().submeshes[submesh];
        return plan.range.size() >= plan.fold_from
                   ? impl_->packed(ExportBytes::Rows, plan.row_bytes)
                   : plan.node_bytes;
    }
    const std::vector<Primitive>& primitives = impl_->scene->submeshes[submesh].primitives;
    const std::uint64_t count = impl_->ranges[submesh].size();
    double bytes = 0.0;
    for (std::uint32_t p = 0; p < primitives.size(); ++p) {
        const Geometry& geometry = *primitives[p].geometry;
        bytes += static_cast<double>(geometry.positions.size()) * bytesPerVertex(submesh, p) +
                 static_cast<double>(geometry.triangleCount()) * bytesPerTriangle(submesh, p);
    }
    return count == 0 ? 0.0 : bytes / static_cast<double>(count);
}

} // namespace lodestone
