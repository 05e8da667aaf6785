#include "scene/gltf/writer_layout.h"

#include <algorithm>

namespace lodestone {

namespace {

std::uint64_t paddedTo4(std::uint64_t size) {
    return (size + 3) & ~std::uint64_t{3};
}

class LayoutMaker {
public:
    LayoutMaker(const ExportPlan& plan, const LodShape& shape, std::vector<bool> folds)
        : plan_(plan), shape_(shape) {
        layout_.folds = std::move(folds);
        layout_.node_index.assign(plan.nodes.size(), kNone);
        layout_.draws.assign(plan.nodes.size(), false);
        layout_.mesh_index.assign(plan.meshes.size(), kNone);
        layout_.accessor_of.assign(plan.stream_count, kNone);
        layout_.groups.resize(plan.groups.size());
        layout_.views.resize(kFirstStrideClass + plan.strides.size());
        shared_.assign(plan.content_count, kNone);
        next_accessor_ = plan.carried.accessorCount();
    }

    Layout make() {
        for (std::uint32_t m = 0; m < plan_.meshes.size(); ++m)
            placeMesh(m);
        for (std::uint32_t s = 0; s < plan_.submeshes.size(); ++s)
            placeInstances(s);
        for (std::uint32_t g = 0; g < plan_.groups.size(); ++g)
            placeGroup(g);
        numberNodes();
        placeViews();
        return std::move(layout_);
    }

private:
    const LodShape::SubmeshShape& shapeOfMesh(const MeshPlan& mesh) const {
        return shape_.submeshes[mesh.submesh];
    }

    static bool hasContent(const PrimitivePlan& plan, const PrimitiveShape& shape) {
        return shape.vertices > 0 && (!plan.indexed || shape.indices > 0);
    }

    void placeMesh(std::uint32_t m) {
        const MeshPlan& mesh = plan_.meshes[m];
        bool drawable = mesh.submesh == kNone;
        if (mesh.submesh != kNone) {
            const LodShape::SubmeshShape& shape = shapeOfMesh(mesh);
            if (!mesh.wanted && shape.kept_instances == 0)
                return;
            for (std::uint32_t p = 0; p < mesh.primitives.size(); ++p)
                if (hasContent(mesh.primitives[p], shape.primitives[p])) {
                    placePrimitive(mesh, p, shape);
                    drawable = true;
                }
        }
        if (drawable)
            layout_.mesh_index[m] = next_mesh_++;
    }

    void
    placePrimitive(const MeshPlan& mesh, std::uint32_t p, const LodShape::SubmeshShape& shape) {
        const PrimitivePlan& primitive = mesh.primitives[p];
        const PrimitiveShape& counts = shape.primitives[p];
        AccessorLayout accessor;
        accessor.submesh = mesh.submesh;
        accessor.primitive = p;
        std::uint32_t flat = primitive.first_stream;
        for (const StreamPlan& stream : primitive.streams) {
            accessor.stream = &stream;
            accessor.view_class = stream.view_class;
            accessor.count = counts.vertices;
            const std::uint64_t stride = plan_.strides[stream.view_class - kFirstStrideClass];
            layout_.accessor_of[flat++] =
                place(accessor, stride, shape.changed ? kNone : stream.content);
        }
        if (counts.indices == 0)
            return;
        const bool wide = counts.vertices > 65535; // 65535 restarts a primitive in 16 bits
        accessor.stream = nullptr;
        accessor.view_class = wide ? kIndex32Class : kIndex16Class;
        accessor.count = counts.indices;
        layout_.accessor_of[flat] =
            place(accessor, wide ? 4 : 2, shape.changed ? kNone : primitive.index_content);
    }

    // The accessor's number; that of one with the same content if there is one already.
    std::uint32_t
    place(AccessorLayout accessor, std::uint64_t element_bytes, std::uint32_t content) {
        if (content != kNone && shared_[content] != kNone)
            return shared_[content];
        ViewLayout& view = layout_.views[accessor.view_class];
        accessor.offset_bytes = view.size_bytes;
        view.size_bytes += paddedTo4(accessor.count * element_bytes);
        layout_.accessors.push_back(accessor);
        if (content != kNone)
            shared_[content] = next_accessor_;
        return next_accessor_++;
    }

    bool isRow(const InstancePlan& instance, bool folds) const {
        return instance.group != kNone && (folds || !plan_.groups[instance.group].folded);
    }

    void placeInstances(std::uint32_t s) {
        const SubmeshPlan& submesh = plan_.submeshes[s];
        const LodShape::SubmeshShape& shape = shape_.submeshes[s];
        if (layout_.mesh_index[submesh.mesh] == kNone)
            return;
        const bool folds = layout_.folds[s];
        const std::uint32_t sole = submesh.sole_group;
        if (sole != kNone && (folds || !plan_.groups[sole].folded)) {
            layout_.groups[sole].rows = shape.kept_instances;
            return;
        }
        forEachKept(submesh.range, shape, [&](std::uint32_t i) {
            const InstancePlan& instance = plan_.instances[i];
            if (isRow(instance, folds))
                ++layout_.groups[instance.group].rows;
            else
                layout_.draws[instance.node] = true;
        });
    }

    // Whether no more than a third of a submesh's triangles is left.
    bool isCoarse(std::uint32_t s) const {
        const LodShape::SubmeshShape& shape = shape_.submeshes[s];
        const std::vector<PrimitivePlan>& full = plan_.meshes[plan_.submeshes[s].mesh].primitives;
        std::uint64_t left = 0;
        std::uint64_t all = 0;
        for (std::size_t p = 0; p < full.size(); ++p) {
            left += shape.primitives[p].indices;
            all += full[p].full.indices;
        }
        return shape.changed && 3 * left <= all;
    }

    void placeGroup(std::uint32_t g) {
        GroupLayout& to = layout_.groups[g];
        if (to.rows == 0)
            return;
        layout_.uses_rows = true;
        layout_.draws[plan_.groups[g].node] = true;
        to.first_accessor = next_accessor_;
        const GroupPlan& group = plan_.groups[g];
        to.coarse = !group.coarse.empty() && isCoarse(group.submesh);
        ViewLayout& view = layout_.views[kInstanceClass];
        for (std::size_t a = 0; a < group.attributes.size(); ++a) {
            to.offset_bytes.push_back(view.size_bytes);
            view.size_bytes += paddedTo4(to.rows * group.stored(a, to.coarse).row_bytes);
            ++next_accessor_;
        }
    }

    void numberNodes() {
        for (const std::uint32_t n : plan_.always_draws)
            layout_.draws[n] = layout_.mesh_index[plan_.nodes[n].mesh] != kNone;
        std::vector<bool> written = layout_.draws;
        for (const std::uint32_t n : plan_.always)
            written[n] = true;
        for (const std::uint32_t n : plan_.bottom_up)
            if (written[n] && plan_.parents[n] != kNone)
                written[plan_.parents[n]] = true;
        std::uint32_t next = 0;
        for (std::size_t n = 0; n < written.size(); ++n)
            if (written[n])
                layout_.node_index[n] = next++;
    }

    void placeViews() {
        std::uint32_t index = plan_.carried.viewCount();
        std::uint64_t offset = plan_.carried.sizeBytes();
        for (ViewLayout& view : layout_.views) {
            if (view.size_bytes == 0)
                continue;
            view.index = index++;
            view.offset_bytes = offset;
            offset += view.size_bytes;
        }
        layout_.binary_bytes = offset;
    }

    const ExportPlan& plan_;
    const LodShape& shape_;
    Layout layout_;
    std::vector<std::uint32_t> shared_; // [contents] accessor that holds it
    std::uint32_t next_accessor_ = 0;
    std::uint32_t next_mesh_ = 0;
};

} // namespace

Layout layOut(const ExportPlan& plan, const LodShape& shape, std::vector<bool> folds) {
    return LayoutMaker(plan, shape, std::move(folds)).make();
}

} // namespace lodestone
