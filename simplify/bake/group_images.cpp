#include "simplify/bake/group_images.h"

#include "simplify/bake/encoded_atlas.h"

#include <set>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

std::uint64_t sizeOf(const Image& image) {
    return image.bytes ? image.bytes->size() : 0;
}

using Slots = std::span<TextureRef Material::*const>;

// Whether everything that a group reads in those slots is JPEG.
bool isFromJpeg(const Scene& scene, const BakedGroup& group, Slots slots) {
    bool any = false;
    for (const BakedPart& part : group.parts) {
        const std::uint32_t material =
            scene.submeshes[part.submesh].primitives[part.primitive].material;
        for (const auto slot : material == kNone ? Slots() : slots) {
            const std::uint32_t image = (scene.materials[material].*slot).image;
            if (image >= scene.images.size())
                continue;
            if (!isJpeg(scene.images[image]))
                return false;
            any = true;
        }
    }
    return any;
}

} // namespace

Result<AtlasImages> encodeAtlases(const Scene& scene,
                                  const BakedGroup& group,
                                  const BakedPixels& pixels,
                                  const BakeOptions& options) {
    struct Job {
        const char* suffix;
        const std::vector<std::uint8_t>* rgba;
        std::vector<TextureRef Material::*> slots;
        Result<Image> image;
    };

    const bool opaque = group.material.alpha_mode == AlphaMode::Opaque;
    std::array<Job, 4> jobs{
        Job{"_color", &pixels.base_color, {&Material::base_color_texture}, {}},
        Job{"_normal", &pixels.normal, {&Material::normal_texture}, {}},
        Job{"_surface",
            &pixels.surface,
            {&Material::metallic_roughness_texture, &Material::occlusion_texture},
            {}},
        Job{"_emission", &pixels.emissive, {&Material::emissive_texture}, {}}};
    const std::string& name = group.material.name;
    const std::string stem = name.empty() ? "atlas" + std::to_string(group.number) : name;
    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
        if (jobs[i].rgba->empty())
            return;
        const bool alpha = i == 0 && !opaque;
        const AtlasPixels atlas{*jobs[i].rgba,
                                group.atlas.size_px,
                                alpha ? Channels::Rgba : Channels::Rgb,
                                isFromJpeg(scene, group, jobs[i].slots)};
        jobs[i].image = encodedAtlas(stem + jobs[i].suffix, atlas, options);
    });
    AtlasImages images;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!jobs[i].image)
            return tl::unexpected(jobs[i].image.error());
        images[i] = std::move(*jobs[i].image);
    }
    return images;
}

std::uint64_t bytesOf(const AtlasImages& images) {
    std::uint64_t bytes = 0;
    for (const Image& image : images)
        bytes += sizeOf(image);
    return bytes;
}

std::uint64_t originalBytes(const Scene& scene, const BakedGroup& group) {
    std::set<std::uint32_t> used;
    for (const BakedPart& part : group.parts) {
        const std::uint32_t material =
            scene.submeshes[part.submesh].primitives[part.primitive].material;
        for (const auto slot : kTextureSlots)
            if (material != kNone)
                used.insert((scene.materials[material].*slot).image);
    }
    std::uint64_t bytes = 0;
    for (const std::uint32_t image : used)
        bytes += image < scene.images.size() ? sizeOf(scene.images[image]) : 0;
    return bytes;
}

} // namespace lodestone
