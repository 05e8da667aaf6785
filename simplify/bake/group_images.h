#pragma once
// The images of a group's triangles: its new atlases, and those that the original shows there.
#include "simplify/bake/baked_group.h"

namespace lodestone {

inline constexpr std::array<TextureRef Material::*, 5> kTextureSlots{
    &Material::base_color_texture,
    &Material::metallic_roughness_texture,
    &Material::normal_texture,
    &Material::occlusion_texture,
    &Material::emissive_texture};

// A group's atlases as files: colour, normal, surface, emission; without bytes where it has none.
using AtlasImages = std::array<Image, 4>;

// scene: what the group was made from; pixels: its own. Parallel over the images.
// Errors: Failed (memory).
Result<AtlasImages> encodeAtlases(const Scene& scene,
                                  const BakedGroup& group,
                                  const BakedPixels& pixels,
                                  const BakeOptions& options);

std::uint64_t bytesOf(const AtlasImages& images);

// Of all images that the group's materials use in the scene, each counted once.
std::uint64_t originalBytes(const Scene& scene, const BakedGroup& group);

} // namespace lodestone
