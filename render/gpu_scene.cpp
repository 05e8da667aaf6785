#include "render/gpu_scene.h"

#include "render/gpu_scene_state.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lodestone {

namespace {

// More new triangles without normals than that in one update are shown faceted: no frame waits.
constexpr std::uint64_t kMostSmoothed = 500'000;

// Evenly spread hues, muted; neighbours in the list differ clearly.
glm::vec4 submeshColor(std::uint32_t index) {
    const double hue = std::fmod(0.12 + index * 0.6180339887498949, 1.0) * 6.0;
    const auto channel = [&](double shift) {
        const double k = std::fmod(hue + shift, 6.0);
        const double pure = std::clamp(std::abs(k - 3.0) - 1.0, 0.0, 1.0);
        const double srgb = 0.30 + (0.45 + 0.1 * (index % 3)) * pure;
        return static_cast<float>(std::pow(srgb, 2.2));
    };
    return {channel(0.0), channel(4.0), channel(2.0), 1.0f};
}

Mirroring mirroringOf(const Scene& scene, InstanceRange range) {
    std::uint32_t mirrored = 0;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
        if (glm::determinant(glm::dmat3(scene.instances[i].transform)) < 0.0)
            ++mirrored;
    if (mirrored == 0)
        return Mirroring::None;
    return mirrored == range.size() ? Mirroring::All : Mirroring::Mixed;
}

struct MapSlot {
    const TextureRef* reference;
    std::uint32_t feature;
    ColorSpace color_space;
};

std::array<MapSlot, kMaterialMaps> mapSlots(const Material& material) {
    return {{{&material.base_color_texture, kBaseMap, ColorSpace::Srgb},
             {&material.metallic_roughness_texture, kMetallicRoughnessMap, ColorSpace::Linear},
             {&material.normal_texture, kNormalMap, ColorSpace::Linear},
             {&material.occlusion_texture, kOcclusionMap, ColorSpace::Linear},
             {&material.emissive_texture, kEmissiveMap, ColorSpace::Srgb}}};
}

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

GpuSceneState::GpuSceneState(std::shared_ptr<RendererState> shared, ScenePtr source)
    : renderer(std::move(shared)), scene(std::move(source)) {}

void GpuSceneState::open() {
    bounds = robustWorldBounds(*scene);
    frame_points = framePoints(*scene, bounds);
    frame.center = bounds.empty ? glm::dvec3(0.0) : bounds.center();
    const double radius = bounds.empty ? 1.0 : bounds.diagonal() * 0.5;
    frame.radius = radius > 0.0 && std::isfinite(radius) ? radius : 1.0;
    revision = renderer->nextRevision();
    openSubmeshes();
    openMaterials();
}

void GpuSceneState::openSubmeshes() {
    const std::vector<InstanceRange> ranges = instanceRanges(*scene);
    submeshes.resize(scene->submeshes.size());
    for (std::uint32_t i = 0; i < submeshes.size(); ++i) {
        submeshes[i].frame = localFrame(scene->submeshes[i]);
        submeshes[i].range = ranges[i];
        submeshes[i].mirroring = mirroringOf(*scene, ranges[i]);
        submeshes[i].id_color = submeshColor(i);
    }
}

void GpuSceneState::openMaterials() {
    std::vector<Material> all = scene->materials;
    all.emplace_back(); // glTF's default: rough, and not quite a metal to look at
    all.back().metallic = 0.0f;
    std::map<TextureWish, std::size_t> wanted;
    std::vector<TextureWish> wishes;
    for (const Material& material : all)
        for (const MapSlot& slot : mapSlots(material)) {
            const TextureWish wish{slot.reference->image, slot.color_space};
            if (wish.image < scene->images.size() && wanted.emplace(wish, wishes.size()).second)
                wishes.push_back(wish);
        }
    textures_ = uploadTextures(*scene, wishes, renderer->info().max_texture_size_px, notes);
    for (const GpuTexture& texture : textures_)
        texture_bytes_ += texture.bytes;

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

std::shared_ptr<const GpuGeometry>
GpuSceneState::geometry(const GeometryPtr& source, std::uint32_t submesh, PrimitiveMode mode) {
    std::weak_ptr<const GpuGeometry>& cached = geometries_[{source.get(), submesh}];
    if (std::shared_ptr<const GpuGeometry> alive = cached.lock())
        return alive;
    GeometryWish wish{mode, MissingNormals::LeaveOut};
    if (lacksNormals(*source, mode) &&
        smoothed_triangles_ + source->triangleCount() <= kMostSmoothed) {
        wish.missing_normals = MissingNormals::Smooth;
        smoothed_triangles_ += source->triangleCount();
    }
    std::shared_ptr<const GpuGeometry> made =
        uploadGeometry(source, submeshes[submesh].frame, wish);
    cached = made;
    ++report_.geometries;
    report_.bytes += made->bytes;
    return made;
}

std::shared_ptr<const InstanceBuffer>
GpuSceneState::instances(std::uint32_t submesh,
                         const std::shared_ptr<const std::vector<std::uint32_t>>& order) {
    std::weak_ptr<const InstanceBuffer>& cached = instances_[{order.get(), submesh}];
    if (std::shared_ptr<const InstanceBuffer> alive = cached.lock())
        return alive;
    const GpuSubmesh& source = submeshes[submesh];
    std::shared_ptr<const InstanceBuffer> made =
        uploadInstances({*scene, source.range, frame, source.frame}, order);
    cached = made;
    ++report_.instance_buffers;
    report_.bytes += made->bytes;
    return made;
}

void GpuSceneState::forgetExpired() {
    std::erase_if(geometries_, [](const auto& entry) { return entry.second.expired(); });
    std::erase_if(instances_, [](const auto& entry) { return entry.second.expired(); });
}

Result<UploadReport> GpuSceneState::update(std::unique_ptr<LodState>& handle, const Lod& lod) {
    if (Result<void> checked = check(lod); !checked)
        return tl::unexpected(checked.error());
    report_ = {};
    smoothed_triangles_ = 0;
    // Items of the last update by place, so that unchanged ones keep their vertex array.
    std::map<std::pair<std::uint32_t, const GpuGeometry*>, DrawItem*> last;
    if (handle)
        for (DrawItem& item : handle->items)
            last[{item.submesh, item.geometry.get()}] = &item;
    auto next = std::make_unique<LodState>();
    const auto default_material = static_cast<std::uint32_t>(scene->materials.size());
    bool changed = !handle;
    for (std::uint32_t s = 0; s < submeshes.size(); ++s) {
        const LodSubmesh& submesh = lod.submeshes[s];
        const std::uint32_t kept =
            submesh.instance_order ? submesh.kept_instances
                                   : std::min(submesh.kept_instances, submeshes[s].range.size());
        for (std::size_t p = 0; p < submesh.primitives.size() && kept > 0; ++p) {
            const Primitive& primitive = scene->submeshes[s].primitives[p];
            const Geometry& shape = *submesh.primitives[p];
            const bool is_list = primitive.mode == PrimitiveMode::Triangles;
            if (shape.positions.empty() || (is_list && shape.indices.size() < 3))
                continue;
            DrawItem item;
            item.geometry = geometry(submesh.primitives[p], s, primitive.mode);
            item.instances = instances(s, submesh.instance_order);
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
            if (is_list)
                next->triangles += shape.triangleCount() * kept;
            next->items.push_back(std::move(item));
        }
    }
    std::stable_partition(next->items.begin(), next->items.end(), [&](const DrawItem& item) {
        return (materials[item.material].features & kAlphaBlend) == 0;
    });
    changed = changed || next->items.size() != handle->items.size();
    next->revision = changed ? renderer->nextRevision() : handle->revision;
    handle = std::move(next);
    last.clear();
    forgetExpired();
    return report_;
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
    auto state = std::make_shared<GpuSceneState>(renderer.shared(), std::move(scene));
    state->open();
    return GpuScene(std::move(state));
}

const ScenePtr& GpuScene::scene() const {
    return state_->scene;
}

const Bounds& GpuScene::bounds() const {
    return state_->bounds;
}

const FramePoints& GpuScene::framePoints() const {
    return state_->frame_points;
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
