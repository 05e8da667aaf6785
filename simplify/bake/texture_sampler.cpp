#include "simplify/bake/texture_sampler.h"

#include "simplify/measure/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// Texel number of any integer position along an axis of `size` texels.
std::int64_t wrapped(std::int64_t at, std::int64_t size, TextureWrap wrap) {
    if (wrap == TextureWrap::ClampToEdge)
        return std::clamp<std::int64_t>(at, 0, size - 1);
    const std::int64_t period = wrap == TextureWrap::MirroredRepeat ? 2 * size : size;
    const std::int64_t in_period = ((at % period) + period) % period;
    return in_period < size ? in_period : period - 1 - in_period;
}

float linearByte(unsigned char byte) {
    static const std::array<float, 256> kTable = [] {
        std::array<float, 256> values{};
        for (std::size_t b = 0; b < values.size(); ++b)
            values[b] = static_cast<float>(linearFromSrgb(static_cast<double>(b) / 255.0));
        return values;
    }();
    return kTable[byte];
}

glm::vec3 corner3(const Attribute* attribute, std::uint32_t vertex) {
    glm::vec3 value(0.0f);
    for (int c = 0; attribute && c < std::min<int>(3, attribute->components); ++c)
        value[c] = attributeValue(*attribute, vertex, static_cast<std::size_t>(c));
    return value;
}

// The directions in which u and v grow, where the file gives no tangents.
void frameFromUv(const Geometry& geometry,
                 const Attribute& uv,
                 const std::array<std::uint32_t, 3>& corners,
                 glm::vec3& tangent,
                 glm::vec3& bitangent) {
    const glm::vec3 e1 = geometry.positions[corners[1]] - geometry.positions[corners[0]];
    const glm::vec3 e2 = geometry.positions[corners[2]] - geometry.positions[corners[0]];
    const glm::vec3 u0 = corner3(&uv, corners[0]);
    const glm::vec3 d1 = corner3(&uv, corners[1]) - u0;
    const glm::vec3 d2 = corner3(&uv, corners[2]) - u0;
    const float sign = d1.x * d2.y - d2.x * d1.y < 0.0f ? -1.0f : 1.0f;
    tangent = (e1 * d2.y - e2 * d1.y) * sign;
    bitangent = (e1 * d2.x - e2 * d1.x) * sign; // glTF's v runs down, green up
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& fallback) {
    const float length = glm::length(v);
    return length > 1e-20f ? v / length : fallback;
}

} // namespace

glm::vec4 blendAttribute(const Attribute& attribute,
                         const std::array<std::uint32_t, 3>& corners,
                         const glm::vec3& weights,
                         const glm::vec4& fallback) {
    glm::vec4 value = fallback;
    for (int c = 0; c < std::min<int>(4, attribute.components); ++c) {
        value[c] = 0.0f;
        for (int k = 0; k < 3; ++k)
            value[c] += weights[k] * attributeValue(attribute,
                                                    corners[static_cast<std::size_t>(k)],
                                                    static_cast<std::size_t>(c));
    }
    return value;
}

TextureSampler::TextureSampler(const Scene& scene) : scene_(scene), images_(scene.images.size()) {
    std::vector<bool> used(scene.images.size());
    for (const Material& material : scene.materials)
        for (const TextureRef* texture : {&material.base_color_texture,
                                          &material.metallic_roughness_texture,
                                          &material.normal_texture,
                                          &material.occlusion_texture,
                                          &material.emissive_texture})
            if (texture->image < used.size())
                used[texture->image] = true;
    tbb::parallel_for(std::size_t{0}, images_.size(), [&](std::size_t i) {
        if (used[i])
            images_[i] = decodeImage(scene.images[i], std::numeric_limits<int>::max());
    });
    for (std::size_t i = 0; i < images_.size(); ++i)
        if (used[i] && !images_[i].rgba)
            notes_.push_back(scene.name + ": image " + std::to_string(i) +
                             " cannot be read and counts as white; use PNG or JPEG");
}

glm::vec4 TextureSampler::sample(const Geometry& geometry,
                                 const TextureRef& texture,
                                 const std::array<std::uint32_t, 3>& corners,
                                 const glm::vec3& weights,
                                 Coding coding) const {
    const glm::vec4 white(1.0f);
    if (texture.image >= images_.size() || !images_[texture.image].rgba)
        return white;
    const Attribute* uv =
        findAttribute(geometry.attributes, "TEXCOORD_" + std::to_string(texture.texcoord));
    if (!uv)
        return white;
    const DecodedImage& image = images_[texture.image];
    const glm::vec4 raw = blendAttribute(*uv, corners, weights, white);
    const glm::vec3 at = texture.uv_transform * glm::vec3(raw.x, raw.y, 1.0f);
    constexpr double kFarTexels = 1e9; // beyond it integers would overflow
    const glm::dvec2 texels =
        glm::clamp(glm::dvec2(at) * glm::dvec2(image.width, image.height), -kFarTexels, kFarTexels);
    const auto texel = [&](std::int64_t x, std::int64_t y) {
        const unsigned char* p =
            image.rgba.get() + 4 * (wrapped(y, image.height, texture.wrap_v) * image.width +
                                    wrapped(x, image.width, texture.wrap_u));
        const float alpha = static_cast<float>(p[3]) / 255.0f;
        if (coding == Coding::Srgb)
            return glm::vec4(linearByte(p[0]), linearByte(p[1]), linearByte(p[2]), alpha);
        return glm::vec4(glm::vec3(p[0], p[1], p[2]) / 255.0f, alpha);
    };
    const glm::dvec2 low = glm::floor(texture.nearest ? texels : texels - 0.5);
    const auto x = static_cast<std::int64_t>(low.x);
    const auto y = static_cast<std::int64_t>(low.y);
    if (texture.nearest)
        return texel(x, y);
    const glm::vec2 share(texels - 0.5 - low);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), share.x),
                    glm::mix(texel(x, y + 1), texel(x + 1, y + 1), share.x),
                    share.y);
}

glm::vec3 TextureSampler::shadingNormal(const Geometry& geometry,
                                        const Material& material,
                                        const std::array<std::uint32_t, 3>& corners,
                                        const glm::vec3& weights) const {
    const glm::vec3& p0 = geometry.positions[corners[0]];
    const glm::vec3 flat =
        unitOr(glm::cross(geometry.positions[corners[1]] - p0, geometry.positions[corners[2]] - p0),
               {0.0f, 0.0f, 1.0f});
    const Attribute* normals = findAttribute(geometry.attributes, "NORMAL");
    const glm::vec3 normal =
        normals ? unitOr(glm::vec3(blendAttribute(*normals, corners, weights, {})), flat) : flat;
    const Attribute* uv = findAttribute(
        geometry.attributes, "TEXCOORD_" + std::to_string(material.normal_texture.texcoord));
    if (material.normal_texture.image >= images_.size() ||
        !images_[material.normal_texture.image].rgba || !uv)
        return normal;
    glm::vec3 tangent;
    glm::vec3 bitangent;
    if (const Attribute* tangents = findAttribute(geometry.attributes, "TANGENT")) {
        const glm::vec4 t = blendAttribute(*tangents, corners, weights, {});
        tangent = unitOr(glm::vec3(t), {1.0f, 0.0f, 0.0f});
        bitangent = glm::cross(normal, tangent) * (t.w < 0.0f ? -1.0f : 1.0f);
    } else {
        frameFromUv(geometry, *uv, corners, tangent, bitangent);
        tangent = unitOr(tangent - normal * glm::dot(normal, tangent), {1.0f, 0.0f, 0.0f});
        const glm::vec3 across = glm::cross(normal, tangent);
        bitangent = glm::dot(across, bitangent) < 0.0f ? -across : across;
    }
    glm::vec3 map(sample(geometry, material.normal_texture, corners, weights, Coding::Linear));
    map = map * 2.0f - 1.0f;
    map.x *= material.normal_scale;
    map.y *= material.normal_scale;
    return unitOr(tangent * map.x + bitangent * map.y + normal * map.z, normal);
}

SurfaceLook TextureSampler::at(const Geometry& geometry,
                               std::uint32_t material_index,
                               const std::array<std::uint32_t, 3>& corners,
                               const glm::vec3& weights) const {
    static const Material kPlain;
    const Material& material =
        material_index < scene_.materials.size() ? scene_.materials[material_index] : kPlain;
    const auto read = [&](const TextureRef& texture, Coding coding) {
        return sample(geometry, texture, corners, weights, coding);
    };
    SurfaceLook look;
    look.base_color = material.base_color * read(material.base_color_texture, Coding::Srgb);
    if (const Attribute* color = findAttribute(geometry.attributes, "COLOR_0"))
        look.base_color *= blendAttribute(*color, corners, weights, glm::vec4(1.0f));
    const glm::vec4 rough = read(material.metallic_roughness_texture, Coding::Linear);
    look.roughness = material.roughness * rough.g;
    look.metallic = material.metallic * rough.b;
    look.occlusion = 1.0f + material.occlusion_strength *
                                (read(material.occlusion_texture, Coding::Linear).r - 1.0f);
    look.emissive = material.emissive * glm::vec3(read(material.emissive_texture, Coding::Srgb));
    look.normal = shadingNormal(geometry, material, corners, weights);
    return look;
}

} // namespace lodestone
