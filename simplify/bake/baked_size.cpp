#include "simplify/bake/baked_size.h"

#include "simplify/bake/bake.h"
#include "simplify/bake/encoded_atlas.h"

#include <algorithm>
#include <set>

namespace lodestone {

namespace {

// Bytes a texel of an atlas, which mixes patches of a texture (JPEG at the quality of the default):
// means over the textured models that the tests know.
constexpr double kPngRate = 1.5;
constexpr double kJpegRate = 0.5;

std::uint64_t bytesOf(const Geometry& geometry) {
    std::uint64_t vertex = sizeof(glm::vec3);
    for (const Attribute& attribute : geometry.attributes)
        vertex += attribute.stride();
    const std::uint64_t index = geometry.positions.size() > 65'535 ? 4 : 2;
    return vertex * geometry.positions.size() + index * geometry.indices.size();
}

// As unfolded: three vertices a triangle.
std::uint64_t bakedBytesOf(const Geometry& geometry, bool normal_mapped) {
    const std::uint64_t vertex = 12 + 12 + 8 + (normal_mapped ? 16 : 0);
    const std::uint64_t index = geometry.indices.size() > 65'535 ? 4 : 2;
    return (vertex + index) * geometry.indices.size();
}

double imageBytes(const Scene& scene, const Material& material, const BakeOptions& options) {
    const double texels = static_cast<double>(options.atlas_px) * options.atlas_px;
    double bytes = 0.0;
    for (const auto slot : {&Material::base_color_texture,
                            &Material::normal_texture,
                            &Material::metallic_roughness_texture,
                            &Material::emissive_texture}) {
        const std::uint32_t image = (material.*slot).image;
        const bool is_color = slot == &Material::base_color_texture;
        if (image >= scene.images.size() && !is_color)
            continue;
        const bool opaque = !is_color || material.alpha_mode == AlphaMode::Opaque;
        const bool from_jpeg = image < scene.images.size() && isJpeg(scene.images[image]);
        const bool jpeg = opaque && (options.format == AtlasFormat::Jpeg ||
                                     (options.format == AtlasFormat::Auto && from_jpeg));
        bytes += texels * (jpeg ? kJpegRate : kPngRate);
    }
    return bytes;
}

} // namespace

std::uint64_t estimateBakedBytes(const Scene& scene,
                                 const Lod& lod,
                                 const BakeOptions& options,
                                 std::uint64_t kept_bytes) {
    auto bytes = static_cast<double>(kept_bytes);
    std::set<std::uint32_t> materials;
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s)
        for (std::size_t p = 0; p < scene.submeshes[s].primitives.size(); ++p) {
            const Primitive& primitive = scene.submeshes[s].primitives[p];
            if (!isBaked(scene, primitive))
                continue;
            const Geometry& geometry = *lod.submeshes[s].primitives[p];
            const bool normal_mapped =
                primitive.material != kNone &&
                scene.materials[primitive.material].normal_texture.image != kNone;
            bytes += static_cast<double>(bakedBytesOf(geometry, normal_mapped));
            bytes -= static_cast<double>(bytesOf(geometry));
            if (materials.empty() || !options.merge_materials)
                materials.insert(primitive.material);
        }
    for (const Image& image : scene.images)
        bytes -= image.bytes ? static_cast<double>(image.bytes->size()) : 0.0;
    for (const std::uint32_t material : materials)
        bytes +=
            imageBytes(scene, material == kNone ? Material() : scene.materials[material], options);
    return static_cast<std::uint64_t>(std::max(bytes, 0.0));
}

} // namespace lodestone
