#include "render/gpu_scene.h"

#include "render/gpu_scene_state.h"
#include "render/material_maps.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lodestone {

namespace {

MaterialBlock materialBlock(const Material& material) {
    MaterialBlock block;
    block.base_color = material.base_color;
    block.emissive = glm::vec4(material.emissive, material.alpha_cutoff);
    block.factors = {
        material.metallic, material.roughness, material.normal_scale, material.occlusion_strength};
    const std::array<MapSlot, kMaterialMaps> slots = mapSlots(material);
    for (std::size_t i = 0; i < kMaterialMaps; ++i) {
        const glm::mat3& uv = slots[i].reference->uv_transform;
        const auto set = static_cast<float>(slots[i].reference->texcoord);
        block.uv_u[i] = {uv[0][0], uv[1][0], uv[2][0], set};
        block.uv_v[i] = {uv[0][1], uv[1][1], uv[2][1], set};
    }
    return block;
}

bool isDrawn(const Geometry& shape, PrimitiveMode mode) {
    return !shape.positions.empty() &&
           (mode != PrimitiveMode::Triangles || shape.indices.size() >= 3);
}

std::uint32_t materialFeatures(const Material& material) {
    std::uint32_t features = 0;
    if (material.alpha_mode == AlphaMode::Mask)
        features |= kAlphaMask;
    if (material.alpha_mode == AlphaMode::Blend)
        features |= kAlphaBlend;
    if (material.unlit)
        features |= kUnlit;
    return features;
}

} // namespace

GpuSceneState::GpuSceneState(std::shared_ptr<RendererState> shared, PreparedScenePtr source)
    : renderer(std::move(shared)), scene(source->scene), bounds(source->bounds),
      frame(source->frame), submeshes(source->submeshes), rig_(source->rig), rest_(source->rest),
      prepared_(std::move(source)) {}

void GpuSceneState::open() {
    revision = renderer->nextRevision();
    openTextures();
    openMaterials();
    notes.insert(notes.end(), rig_->notes.begin(), rig_->notes.end());
    uploadPose();
}

// Names only: the pictures follow one by one.
void GpuSceneState::openTextures() {
    textures_.resize(prepared_->images.size());
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        if (prepared_->images[i].fault.empty())
            textures_[i].texture = GlTexture::create();
        else
            notes.push_back(prepared_->images[i].fault);
    }
}

bool GpuSceneState::uploadNextTexture() {
    if (!prepared_)
        return false;
    const std::vector<DecodedImage>& images = prepared_->images;
    while (next_texture_ < images.size() && !images[next_texture_].rgba)
        ++next_texture_;
    if (next_texture_ >= images.size()) {
        prepared_.reset();
        return false;
    }
    GpuTexture& texture = textures_[next_texture_];
    texture = uploadTexture(std::move(texture.texture),
                            images[next_texture_],
                            prepared_->wishes[next_texture_].color_space);
    texture_bytes_ += texture.bytes;
    ++next_texture_;
    return true;
}

void GpuSceneState::openMaterials() {
    const std::vector<Material> all = drawnMaterials(*scene);
    std::map<TextureWish, std::size_t> wanted;
    for (std::size_t i = 0; i < prepared_->wishes.size(); ++i)
        wanted.emplace(prepared_->wishes[i], i);

    const auto alignment = static_cast<std::size_t>(renderer->uniformAlignment());
    const std::size_t step = (sizeof(MaterialBlock) + alignment - 1) / alignment * alignment;
    std::vector<std::byte> blocks(step * all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        GpuMaterial material;
        material.features = materialFeatures(all[i]);
        material.double_sided = all[i].double_sided;
        material.block_offset = static_cast<GLintptr>(i * step);
        const MaterialBlock block = materialBlock(all[i]);
        std::memcpy(&blocks[i * step], &block, sizeof block);
        const std::array<MapSlot, kMaterialMaps> slots = mapSlots(all[i]);
        for (std::size_t m = 0; m < kMaterialMaps; ++m) {
            const TextureRef& reference = *slots[m].reference;
            const auto found = wanted.find({reference.image, slots[m].color_space});
            if (found == wanted.end() || !textures_[found->second].texture)
                continue;
            material.features |= slots[m].feature;
            material.maps[m] = {
                textures_[found->second].texture.name(),
                renderer->sampler({reference.wrap_u, reference.wrap_v, reference.nearest})};
        }
        materials.push_back(material);
    }
    material_blocks = GlBuffer::create();
    glBindBuffer(GL_UNIFORM_BUFFER, material_blocks.name());
    glBufferData(
        GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(blocks.size()), blocks.data(), GL_STATIC_DRAW);
    glBindBuffer(GL_UNIFORM_BUFFER, 0);
}

Result<void> GpuSceneState::check(const Lod& lod) const {
    const auto misfit = [](const std::string& what) {
        return fail(ErrorKind::Usage, "this LOD belongs to another scene: " + what);
    };
    if (lod.submeshes.size() != submeshes.size())
        return misfit("the number of submeshes differs");
    for (std::size_t s = 0; s < submeshes.size(); ++s) {
        const LodSubmesh& submesh = lod.submeshes[s];
        const std::string name = "submesh " + std::to_string(s);
        if (submesh.primitives.size() != scene->submeshes[s].primitives.size())
            return misfit("the number of primitives of " + name + " differs");
        for (const GeometryPtr& geometry : submesh.primitives)
            if (!geometry)
                return misfit("a primitive of " + name + " is missing");
        if (!submesh.instance_order)
            continue;
        if (submesh.kept_instances > submesh.instance_order->size())
            return misfit(name + " keeps more instances than its order names");
        for (const std::uint32_t id : *submesh.instance_order)
            if (id < submeshes[s].range.begin || id >= submeshes[s].range.end)
                return misfit("the instance order of " + name + " names another submesh's");
    }
    return {};
}

// Instances of the submesh that are drawn; nothing to draw: 0.
std::uint32_t GpuSceneState::keptInstances(const LodSubmesh& submesh, std::uint32_t index) const {
    return submesh.instance_order ? submesh.kept_instances
                                  : std::min(submesh.kept_instances, submeshes[index].range.size());
}

LodPackage GpuSceneState::missingParts(const Lod& lod) {
    LodPackage package;
    LodPackage::Parts& parts = *package.parts_;
    parts.scene = scene;
    parts.scene_frame = frame;
    for (std::uint32_t s = 0; s < submeshes.size(); ++s) {
        const LodSubmesh& submesh = lod.submeshes[s];
        if (keptInstances(submesh, s) == 0)
            continue;
        bool draws = false;
        for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
            const GeometryPtr& shape = submesh.primitives[p];
            const PrimitiveMode mode = scene->submeshes[s].primitives[p].mode;
            if (!isDrawn(*shape, mode))
                continue;
            draws = true;
            if (!geometries_[{shape.get(), s}].expired())
                continue;
            const std::uint64_t triangles = shape->triangleCount() + shape->positions.size() / 2;
            parts.work +=
                lacksNormals(*shape, mode) ? LodPackage::kSmoothWork * triangles : triangles;
            parts.geometries.push_back({shape, s, mode, submeshes[s].frame, {}, nullptr});
        }
        if (!draws || !instances_[{submesh.instance_order.get(), s}].expired())
            continue;
        parts.work += submeshes[s].range.size();
        parts.instances.push_back(
            {submesh.instance_order, s, submeshes[s].range, submeshes[s].frame, {}, nullptr});
    }
    return package;
}

Result<LodPackage> GpuSceneState::package(const Lod& lod) {
    if (Result<void> checked = check(lod); !checked)
        return tl::unexpected(checked.error());
    return missingParts(lod);
}

void GpuSceneState::offer(const LodPackage& package) {
    for (const auto& part : package.parts_->geometries)
        geometries_[{part.source.get(), part.submesh}] = part.gpu;
    for (const auto& part : package.parts_->instances)
        instances_[{part.order.get(), part.submesh}] = part.gpu;
}

void GpuSceneState::forgetExpired() {
    std::erase_if(geometries_, [](const auto& entry) { return entry.second.expired(); });
    std::erase_if(instances_, [](const auto& entry) { return entry.second.expired(); });
}

Result<UploadReport> GpuSceneState::update(std::unique_ptr<LodState>& handle, const Lod& lod) {
    Result<LodPackage> package = this->package(lod);
    if (!package)
        return tl::unexpected(package.error());
    package->pack();
    UploadReport report;
    report.geometries = static_cast<std::uint32_t>(package->parts_->geometries.size());
    report.instance_buffers = static_cast<std::uint32_t>(package->parts_->instances.size());
    report.bytes = package->copy(std::numeric_limits<std::uint64_t>::max());
    offer(*package);
    bool changed = !handle;
    auto next = assemble(lod, handle.get(), changed);
    changed = changed || next->items.size() != handle->items.size();
    next->revision = changed ? renderer->nextRevision() : handle->revision;
    handle = std::move(next);
    forgetExpired();
    return report;
}

// Everything it needs is on the GPU. Unchanged items take over the vertex array of the last ones.
std::unique_ptr<LodState>
GpuSceneState::assemble(const Lod& lod, LodState* last_state, bool& changed) {
    std::map<std::pair<std::uint32_t, const GpuGeometry*>, DrawItem*> last;
    if (last_state)
        for (DrawItem& item : last_state->items)
            last[{item.submesh, item.geometry.get()}] = &item;
    auto next = std::make_unique<LodState>();
    const auto default_material = static_cast<std::uint32_t>(scene->materials.size());
    for (std::uint32_t s = 0; s < submeshes.size(); ++s) {
        const LodSubmesh& submesh = lod.submeshes[s];
        const std::uint32_t kept = keptInstances(submesh, s);
        for (std::size_t p = 0; p < submesh.primitives.size() && kept > 0; ++p) {
            const Primitive& primitive = scene->submeshes[s].primitives[p];
            const Geometry& shape = *submesh.primitives[p];
            if (!isDrawn(shape, primitive.mode))
                continue;
            DrawItem item;
            item.geometry = geometries_[{&shape, s}].lock();
            item.instances = instances_[{submesh.instance_order.get(), s}].lock();
            item.submesh = s;
            item.mode = primitive.mode;
            item.kept_instances = kept;
            item.material = std::min(primitive.material, default_material);
            if (const auto found = last.find({s, item.geometry.get()});
                found != last.end() && found->second->vertex_array &&
                found->second->instances == item.instances) {
                item.vertex_array = std::move(found->second->vertex_array);
                changed = changed || found->second->kept_instances != kept;
            } else {
                item.vertex_array = makeVertexArray(*item.geometry, *item.instances);
                changed = true;
            }
            if (primitive.mode == PrimitiveMode::Triangles)
                next->triangles += shape.triangleCount() * kept;
            next->items.push_back(std::move(item));
        }
    }
    std::stable_partition(next->items.begin(), next->items.end(), [&](const DrawItem& item) {
        return (materials[item.material].features & kAlphaBlend) == 0;
    });
    return next;
}

std::uint64_t GpuSceneState::memoryBytes() const {
    std::uint64_t bytes = texture_bytes_;
    for (const auto& [key, cached] : geometries_)
        if (const auto alive = cached.lock())
            bytes += alive->bytes;
    for (const auto& [key, cached] : instances_)
        if (const auto alive = cached.lock())
            bytes += alive->bytes;
    return bytes;
}

LodHandle::LodHandle() = default;
LodHandle::~LodHandle() = default;
LodHandle::LodHandle(LodHandle&&) noexcept = default;
LodHandle& LodHandle::operator=(LodHandle&&) noexcept = default;

std::uint64_t LodHandle::revision() const {
    return state_ ? state_->revision : 0;
}

std::uint64_t LodHandle::triangles() const {
    return state_ ? state_->triangles : 0;
}

GpuScene::GpuScene(std::shared_ptr<GpuSceneState> state) : state_(std::move(state)) {}

GpuScene::GpuScene(GpuScene&&) noexcept = default;
GpuScene& GpuScene::operator=(GpuScene&&) noexcept = default;
GpuScene::~GpuScene() = default;

Result<GpuScene> GpuScene::create(const Renderer& renderer, ScenePtr scene) {
    if (!scene)
        return fail(ErrorKind::Usage, "there is no scene to show");
    GpuScene created =
        create(renderer, prepareScene(std::move(scene), renderer.info().max_texture_size_px));
    while (created.uploadNextTexture()) {
    }
    return created;
}

GpuScene GpuScene::create(const Renderer& renderer, const PreparedScenePtr& prepared) {
    auto state = std::make_shared<GpuSceneState>(renderer.shared(), prepared);
    state->open();
    return GpuScene(std::move(state));
}

bool GpuScene::uploadNextTexture() {
    return state_->uploadNextTexture();
}

Result<LodPackage> GpuScene::package(const Lod& lod) const {
    return state_->package(lod);
}

void GpuScene::offer(const LodPackage& package) {
    state_->offer(package);
}

void GpuScene::setMoment(const Moment& moment) {
    state_->setMoment(moment);
}

const ScenePtr& GpuScene::scene() const {
    return state_->scene;
}

const Bounds& GpuScene::bounds() const {
    return state_->bounds;
}

FramePoints GpuScene::framePoints() const {
    return lodestone::framePoints(*state_->scene, state_->bounds);
}

const std::vector<std::string>& GpuScene::notes() const {
    return state_->notes;
}

std::uint64_t GpuScene::memoryBytes() const {
    return state_->memoryBytes();
}

std::uint64_t GpuScene::revision() const {
    return state_->revision;
}

Result<UploadReport> GpuScene::update(LodHandle& handle, const Lod& lod) {
    return state_->update(handle.state_, lod);
}

void GpuScene::setHiddenSubmeshes(std::vector<bool> hidden) {
    hidden.resize(hidden.empty() ? 0 : state_->submeshes.size(), false);
    if (hidden == state_->hidden)
        return;
    state_->hidden = std::move(hidden);
    state_->revision = state_->renderer->nextRevision();
}

} // namespace lodestone
