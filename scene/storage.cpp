#include "scene/storage.h"

#include <algorithm>
#include <limits>

namespace lodestone {

namespace {

// Ways to expand some of the submeshes with several instances, at most.
constexpr std::size_t kMostSteps = 10;

double strideBytes(const ExportPlan& plan, const PrimitivePlan& primitive) {
    double bytes = 0.0;
    for (const StreamPlan& stream : primitive.streams)
        bytes += plan.strides[stream.view_class - kFirstStrideClass];
    return bytes;
}

// The share of a submesh's triangles below which it is smaller with every instance's own vertices,
// estimated; infinite for what has one instance.
double breakEvenShare(const ExportPlan& plan, std::size_t s) {
    constexpr double kMeshBytes = 60.0;
    constexpr double kAccessorBytes = 100.0;
    constexpr double kBoundsBytes = 90.0; // min and max of the positions
    const SubmeshPlan& submesh = plan.submeshes[s];
    const double instances = submesh.range.size();
    if (instances < 2.0)
        return std::numeric_limits<double>::infinity();
    double geometry_bytes = 0.0;
    double json_bytes = kMeshBytes;
    for (const PrimitivePlan& primitive : plan.meshes[submesh.mesh].primitives) {
        geometry_bytes += strideBytes(plan, primitive) * primitive.full.vertices +
                          (primitive.full.vertices > 65535 ? 4.0 : 2.0) * primitive.full.indices;
        json_bytes +=
            kAccessorBytes * static_cast<double>(primitive.streams.size() + 1) + kBoundsBytes;
    }
    const double transform_bytes = submesh.range.size() >= submesh.fold_from
                                       ? submesh.fold_fixed_bytes + instances * submesh.row_bytes
                                       : instances * submesh.node_bytes;
    return (json_bytes + transform_bytes) / ((instances - 1.0) * std::max(geometry_bytes, 1.0));
}

bool anyChanged(const LodShape& shape) {
    return std::ranges::any_of(shape.submeshes, &LodShape::SubmeshShape::changed);
}

} // namespace

StoragePlan::StoragePlan(const Scene& scene, const ExportOptions& options) : scene_(scene) {
    std::vector<bool> merging(scene.submeshes.size(), false);
    if (options.instancing == Instancing::Expand) {
        expansion_ = planExpansion(scene);
    } else if (options.instancing == Instancing::Auto && !isPacked(options)) {
        merging = mergingSubmeshes(scene);
        if (std::ranges::find(merging, true) != merging.end())
            expansion_ = planBesides(scene);
    }
    const Scene& written = expansion_ ? *expansion_->skeleton : scene;
    // Vertices of a merged submesh are only known by their bounds.
    const bool on_grids = options.compression != Compression::None;
    bounds_ = submeshBounds(written, expansion_ && on_grids ? worldBounds(scene) : Bounds{});
    plan_ = std::make_unique<const ExportPlan>(
        written, options, planGrids(written, options.compression, bounds_));
    planWays(merging);
}

const Expansion* StoragePlan::replacement() const {
    return plan_->options.instancing == Instancing::Expand ? &*expansion_ : nullptr;
}

// merging: [scene.submeshes]
void StoragePlan::planWays(const std::vector<bool>& merging) {
    ways_.emplace_back(merging.size(), false);
    std::vector<std::pair<double, std::uint32_t>> order; // the soonest worth it first
    for (std::uint32_t s = 0; s < merging.size(); ++s)
        if (merging[s] && plan_->submeshes[s].range.size() > 0)
            order.emplace_back(-breakEvenShare(*plan_, s), s);
    std::ranges::sort(order);
    const auto shared = std::ranges::find_if(order, [](const auto& entry) {
        return entry.first > -std::numeric_limits<double>::infinity();
    });
    const auto singles = static_cast<std::size_t>(shared - order.begin());
    const std::size_t steps = std::min(kMostSteps, order.size() - singles);
    std::vector<bool> way = ways_.front();
    std::size_t done = 0;
    for (std::size_t step = 0; step <= steps; ++step) {
        const std::size_t end =
            singles + (steps == 0 ? 0 : (order.size() - singles) * step / steps);
        if (end == 0)
            continue;
        for (; done < end; ++done)
            way[order[done].second] = true;
        ways_.push_back(way);
    }
}

// What a submesh's geometry weighs where it is merged, without padding.
std::uint64_t StoragePlan::mergedBytes(const LodShape& shape, std::size_t submesh) const {
    const ExportPlan& plan = *plan_;
    const LodShape::SubmeshShape& from = shape.submeshes[submesh];
    double bytes = 0.0;
    for (std::size_t p = 0; p < from.primitives.size(); ++p) {
        const PrimitivePlan& primitive = plan.meshes[plan.submeshes[submesh].mesh].primitives[p];
        bytes += strideBytes(plan, primitive) * from.primitives[p].vertices +
                 2.0 * from.primitives[p].indices;
    }
    return static_cast<std::uint64_t>(bytes * from.kept_instances);
}

LodShape StoragePlan::shapeIn(const LodShape& shape, std::size_t way) const {
    if (!expansion_)
        return shape;
    if (replacement())
        return expandShape(*expansion_, scene_, shape);
    const std::vector<bool>& merged = ways_[way];
    LodShape to = shape;
    for (std::size_t s = 0; s < merged.size(); ++s)
        if (merged[s])
            to.submeshes[s].kept_instances = 0;
    for (const ExpandGroup& group : expansion_->groups) {
        PrimitiveShape counts;
        for (const ExpandPart& part : group.parts) {
            if (!merged[part.submesh])
                continue;
            const LodShape::SubmeshShape& from = shape.submeshes[part.submesh];
            counts.vertices += from.primitives[part.primitive].vertices * from.kept_instances;
            counts.indices += from.primitives[part.primitive].indices * from.kept_instances;
        }
        to.submeshes.push_back({{counts}, counts.vertices > 0 ? 1U : 0U, true, nullptr});
    }
    return to;
}

StoredShape StoragePlan::stored(const LodShape& shape, std::size_t way) const {
    StoredShape stored;
    stored.way = way;
    stored.shape = shapeIn(shape, way);
    stored.layout = chooseLayout(*plan_, stored.shape);
    stored.bytes = exportedBytes(*plan_, stored.layout);
    return stored;
}

StoredShape StoragePlan::smallest(const LodShape& shape) const {
    StoredShape best = stored(shape, 0);
    if (ways_.size() == 1 || !anyChanged(shape))
        return best;
    std::uint64_t merged_bytes = 0; // of the way's geometry that is merged
    for (std::size_t way = 1; way < ways_.size(); ++way) {
        for (std::size_t s = 0; s < ways_[way].size(); ++s)
            if (ways_[way][s] && !ways_[way - 1][s])
                merged_bytes += mergedBytes(shape, s);
        if (merged_bytes >= best.bytes)
            break; // nor does any way after it, which merges more
        StoredShape other = stored(shape, way);
        if (other.bytes < best.bytes)
            best = std::move(other);
    }
    return best;
}

Result<Lod> StoragePlan::storedLod(const Lod& lod, std::size_t way) const {
    if (!expansion_)
        return lod;
    if (replacement())
        return expandLod(*expansion_, scene_, lod, {});
    const std::vector<bool>& merged = ways_[way];
    Lod parts = lod;
    for (std::size_t s = 0; s < merged.size(); ++s)
        if (!merged[s])
            parts.submeshes[s].kept_instances = 0;
    Result<Lod> to = expandLod(*expansion_, scene_, parts, {});
    if (!to)
        return to;
    for (std::size_t s = 0; s < merged.size(); ++s)
        if (!merged[s])
            to->submeshes[s] = lod.submeshes[s];
    countLod(*to);
    return to;
}

} // namespace lodestone
