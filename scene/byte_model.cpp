#include "scene/export.h"
#include "scene/gltf/writer.h"

namespace lodestone {

struct ByteModel::Impl {
    Impl(ScenePtr from, const ExportOptions& options)
        : scene(std::move(from)), plan(*scene, options) {}

    ScenePtr scene;
    ExportPlan plan;
};

ByteModel::ByteModel(ScenePtr scene, const ExportOptions& options)
    : impl_(std::make_unique<Impl>(std::move(scene), options)) {}

ByteModel::~ByteModel() = default;
ByteModel::ByteModel(ByteModel&&) noexcept = default;
ByteModel& ByteModel::operator=(ByteModel&&) noexcept = default;

std::uint64_t ByteModel::bytes(const LodShape& shape) const {
    return exportedBytes(impl_->plan, chooseLayout(impl_->plan, shape));
}

double ByteModel::bytesPerVertex(std::uint32_t submesh, std::uint32_t primitive) const {
    const ExportPlan& plan = impl_->plan;
    double bytes = 0.0;
    const MeshPlan& mesh = plan.meshes[plan.submeshes[submesh].mesh];
    for (const StreamPlan& stream : mesh.primitives[primitive].streams)
        bytes += plan.strides[stream.view_class - kFirstStrideClass];
    return bytes;
}

double ByteModel::bytesPerTriangle(std::uint32_t submesh, std::uint32_t primitive) const {
    const ExportPlan& plan = impl_->plan;
    const MeshPlan& mesh = plan.meshes[plan.submeshes[submesh].mesh];
    return mesh.primitives[primitive].full.vertices > 65535 ? 12.0 : 6.0;
}

double ByteModel::bytesPerInstance(std::uint32_t submesh) const {
    const SubmeshPlan& plan = impl_->plan.submeshes[submesh];
    return plan.range.size() >= plan.fold_from ? plan.row_bytes : plan.node_bytes;
}

} // namespace lodestone
