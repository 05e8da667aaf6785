#include "render/material_maps.h"
#include "render/prepared_scene_parts.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace lodestone {

std::vector<Material> drawnMaterials(const Scene& scene) {
    std::vector<Material> all = scene.materials;
    all.emplace_back(); // glTF's default: rough, and not quite a metal to look at
    all.back().metallic = 0.0f;
    return all;
}

std::array<MapSlot, kMaterialMaps> mapSlots(const Material& material) {
    return {{{&material.base_color_texture, kBaseMap, ColorSpace::Srgb},
             {&material.metallic_roughness_texture, kMetallicRoughnessMap, ColorSpace::Linear},
             {&material.normal_texture, kNormalMap, ColorSpace::Linear},
             {&material.occlusion_texture, kOcclusionMap, ColorSpace::Linear},
             {&material.emissive_texture, kEmissiveMap, ColorSpace::Srgb}}};
}

namespace {

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

std::vector<GpuSubmesh> submeshesOf(const Scene& scene) {
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    std::vector<GpuSubmesh> submeshes(scene.submeshes.size());
    for (std::uint32_t i = 0; i < submeshes.size(); ++i) {
        submeshes[i].frame = localFrame(scene.submeshes[i]);
        submeshes[i].box = localBounds(scene.submeshes[i]);
        submeshes[i].range = ranges[i];
        submeshes[i].mirroring = mirroringOf(scene, ranges[i]);
        submeshes[i].id_color = submeshColor(i);
    }
    return submeshes;
}

std::vector<TextureWish> wishesOf(const Scene& scene) {
    std::set<TextureWish> known;
    std::vector<TextureWish> wishes;
    for (const Material& material : drawnMaterials(scene))
        for (const MapSlot& slot : mapSlots(material)) {
            const TextureWish wish{slot.reference->image, slot.color_space};
            if (wish.image < scene.images.size() && known.insert(wish).second)
                wishes.push_back(wish);
        }
    return wishes;
}

} // namespace

PreparedScenePtr prepareScene(ScenePtr scene, int max_texture_size_px) {
    auto prepared = std::make_shared<PreparedScene>();
    prepared->bounds = robustWorldBounds(*scene);
    prepared->frame.center = prepared->bounds.empty ? glm::dvec3(0.0) : prepared->bounds.center();
    const double radius = prepared->bounds.empty ? 1.0 : prepared->bounds.diagonal() * 0.5;
    prepared->frame.radius = radius > 0.0 && std::isfinite(radius) ? radius : 1.0;
    prepared->submeshes = submeshesOf(*scene);
    prepared->wishes = wishesOf(*scene);
    prepared->images = decodeImages(*scene, prepared->wishes, max_texture_size_px);
    prepared->rig = readRig(*scene);
    prepared->rest = poseAt(*prepared->rig, {});
    prepared->scene = std::move(scene);
    return prepared;
}

std::uint64_t preparationWork(const Scene& scene) {
    constexpr std::uint64_t kBytesPerVertex = 8; // decoding an image byte is so much cheaper
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    std::uint64_t work = 0;
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s)
        for (const Primitive& primitive : scene.submeshes[s].primitives)
            work += primitive.geometry->positions.size() * ranges[s].size();
    for (const Image& image : scene.images)
        work += image.bytes ? image.bytes->size() / kBytesPerVertex : 0;
    return work;
}

} // namespace lodestone
