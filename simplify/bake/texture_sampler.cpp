#include "simplify/bake/texture_sampler.h"

#include <algorithm>
#include <array>

namespace lodestone {

namespace {

using Coding = TextureImages::Coding;

constexpr std::array<TextureImages::Slot, 5> kSlots{&Material::base_color_texture,
                                                    &Material::metallic_roughness_texture,
                                                    &Material::normal_texture,
                                                    &Material::occlusion_texture,
                                                    &Material::emissive_texture};

glm::vec3 corner3(const Attribute* attribute, std::uint32_t vertex) {
    glm::vec3 value(0.0f);
    for (int c = 0; attribute && c < std::min<int>(3, attribute->components); ++c)
        value[c] = attributeValue(*attribute, vertex, static_cast<std::size_t>(c));
    return value;
}

// The directions in which u and v grow, where the file gives no tangents.
void frameFromUv(const Geometry& geometry,
                 const Attribute* uv,
                 const std::array<std::uint32_t, 3>& corners,
                 glm::vec3& tangent,
                 glm::vec3& bitangent) {
    const glm::vec3 e1 = geometry.positions[corners[1]] - geometry.positions[corners[0]];
    const glm::vec3 e2 = geometry.positions[corners[2]] - geometry.positions[corners[0]];
    const glm::vec3 u0 = corner3(uv, corners[0]);
    const glm::vec3 d1 = corner3(uv, corners[1]) - u0;
    const glm::vec3 d2 = corner3(uv, corners[2]) - u0;
    const float sign = d1.x * d2.y - d2.x * d1.y < 0.0f ? -1.0f : 1.0f;
    tangent = (e1 * d2.y - e2 * d1.y) * sign;
    bitangent = (e1 * d2.x - e2 * d1.x) * sign; // glTF's v runs down, green up
}

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& fallback) {
    const float length = glm::length(v);
    return length > 1e-20f ? v / length : fallback;
}

} // namespace

TextureSampler::TextureSampler(const Scene& scene) : scene_(scene), images_(scene, kSlots) {}

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
    if (!images_.covers(geometry, material.normal_texture))
        return normal;
    glm::vec3 tangent;
    glm::vec3 bitangent;
    if (const Attribute* tangents = findAttribute(geometry.attributes, "TANGENT")) {
        const glm::vec4 t = blendAttribute(*tangents, corners, weights, {});
        tangent = unitOr(glm::vec3(t), {1.0f, 0.0f, 0.0f});
        bitangent = glm::cross(normal, tangent) * (t.w < 0.0f ? -1.0f : 1.0f);
    } else {
        const Attribute* uv = findAttribute(
            geometry.attributes, "TEXCOORD_" + std::to_string(material.normal_texture.texcoord));
        frameFromUv(geometry, uv, corners, tangent, bitangent);
        tangent = unitOr(tangent - normal * glm::dot(normal, tangent), {1.0f, 0.0f, 0.0f});
        const glm::vec3 across = glm::cross(normal, tangent);
        bitangent = glm::dot(across, bitangent) < 0.0f ? -across : across;
    }
    glm::vec3 map(
        images_.sample(geometry, material.normal_texture, corners, weights, Coding::Linear));
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
        return images_.sample(geometry, texture, corners, weights, coding);
    };
    SurfaceLook look;
    look.base_color = material.base_color * read(material.base_color_texture, Coding::Srgb) *
                      vertexColorAt(geometry, corners, weights);
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
