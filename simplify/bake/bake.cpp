#include "simplify/bake/bake.h"

#include "scene/scene_builder.h"
#include "simplify/bake/baked_group.h"
#include "simplify/bake/group_images.h"
#include "simplify/bake/texel_density.h"
#include "simplify/bake/texture_choice.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <iterator>
#include <map>
#include <optional>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

bool hasTexture(const Material& material) {
    return std::ranges::any_of(kTextureSlots,
                               [&](auto slot) { return (material.*slot).image != kNone; });
}

// Everything a bake works on.
struct Bake {
    const Scene& scene;
    const BakeOptions& options;
    std::vector<BakeSource> sources; // [submeshes]
    std::vector<BakedGroup> groups;
    std::map<std::vector<std::uint32_t>, std::size_t> group_of; // by what must agree
    std::vector<std::vector<std::size_t>> primitive_group;      // [submeshes][primitives]
    // [submeshes][primitives] first triangle in its group
    std::vector<std::vector<std::size_t>> first_triangle;

    static constexpr std::size_t kPlain = ~std::size_t{0}; // no group: stays as it is
};

// One atlas a material, or one for all that are drawn the same way.
std::vector<std::uint32_t> groupKey(const Bake& bake, std::uint32_t material_index) {
    if (!bake.options.merge_materials || material_index == kNone)
        return {material_index};
    const Material& material = bake.scene.materials[material_index];
    return {kNone,
            static_cast<std::uint32_t>(material.alpha_mode),
            material.double_sided ? 1u : 0u,
            material.unlit ? 1u : 0u};
}

void addToGroup(Bake& bake, std::uint32_t submesh, std::uint32_t primitive_index) {
    const Primitive& primitive = bake.scene.submeshes[submesh].primitives[primitive_index];
    const auto [found, fresh] =
        bake.group_of.try_emplace(groupKey(bake, primitive.material), bake.groups.size());
    if (fresh)
        bake.groups.emplace_back().number = found->second;
    BakedGroup& group = bake.groups[found->second];
    const Material material =
        primitive.material == kNone ? Material{} : bake.scene.materials[primitive.material];
    if (fresh)
        group.material = material;
    group.normals |= material.normal_texture.image != kNone;
    group.surface |= material.metallic_roughness_texture.image != kNone ||
                     material.occlusion_texture.image != kNone ||
                     material.metallic != group.material.metallic ||
                     material.roughness != group.material.roughness;
    group.emission |=
        material.emissive_texture.image != kNone || material.emissive != group.material.emissive;
    group.parts.push_back({submesh, primitive_index});
    bake.primitive_group[submesh][primitive_index] = found->second;
    bake.first_triangle[submesh][primitive_index] = group.triangles.size();
    const auto faces =
        static_cast<std::uint32_t>(bake.sources[submesh].map->facesOf(primitive_index).size());
    for (std::uint32_t face = 0; face < faces; ++face)
        group.triangles.push_back({submesh, primitive_index, face, {0, 1, 2}});
}

void makeGroups(Bake& bake) {
    for (std::uint32_t s = 0; s < bake.scene.submeshes.size(); ++s) {
        const std::vector<Primitive>& primitives = bake.scene.submeshes[s].primitives;
        bake.primitive_group.emplace_back(primitives.size(), Bake::kPlain);
        bake.first_triangle.emplace_back(primitives.size(), 0);
        for (std::uint32_t p = 0; p < primitives.size(); ++p)
            if (isBaked(bake.scene, primitives[p]))
                addToGroup(bake, s, p);
    }
}

Result<void> packGroups(Bake& bake) {
    for (BakedGroup& group : bake.groups) {
        std::vector<FlatTriangle> flat;
        for (BakedTriangle& triangle : group.triangles) {
            const BakeSource& source = bake.sources[triangle.submesh];
            const std::uint32_t face = source.map->facesOf(triangle.primitive)[triangle.face];
            flat.push_back(flatten(source.map->triangle(face), triangle.order));
            flat.back().base *= source.stretch;
            flat.back().height *= source.stretch;
        }
        Result<Atlas> atlas = packAtlas(flat, bake.options.atlas_px);
        if (!atlas)
            return fail(atlas.error().kind,
                        bake.scene.name + ": material '" + group.material.name +
                            "': " + atlas.error().message);
        group.atlas = std::move(*atlas);
    }
    return {};
}

Result<void>
readSources(Bake& bake, std::span<const BakeSubmesh> submeshes, const JobContext& job) {
    bake.sources.resize(submeshes.size());
    tbb::parallel_for(std::size_t{0}, submeshes.size(), [&](std::size_t s) {
        const Submesh& submesh = bake.scene.submeshes[s];
        const bool needed = std::ranges::any_of(
            submesh.primitives, [&](const Primitive& p) { return isBaked(bake.scene, p); });
        if (!needed || job.stopRequested())
            return;
        const BakeSubmesh& from = submeshes[s];
        bake.sources[s] = {
            &submesh,
            from.sequence,
            std::make_unique<const SuccessiveMap>(*from.sequence, submesh, from.step, job),
            readOutSubmesh(*from.sequence, submesh, from.step, from.growth, from.pivot),
            from.stretch};
    });
    if (job.stopRequested())
        return cancelled();
    return {};
}

template <class Value>
Attribute floatAttribute(std::string semantic, const std::vector<Value>& values) {
    Attribute attribute;
    attribute.semantic = std::move(semantic);
    attribute.components = sizeof(Value) / sizeof(float);
    attribute.bytes.resize(values.size() * sizeof(Value));
    std::memcpy(attribute.bytes.data(), values.data(), attribute.bytes.size());
    return attribute;
}

// Three vertices a triangle, with the group's texture coordinates.
GeometryPtr unfold(const Bake& bake, std::uint32_t s, std::uint32_t p) {
    const BakeSource& source = bake.sources[s];
    const BakedGroup& group = bake.groups[bake.primitive_group[s][p]];
    const Geometry& from = *source.primitives[p];
    auto geometry = std::make_shared<Geometry>();
    std::vector<glm::vec2> uv;
    std::vector<glm::vec3> normals;
    std::vector<glm::vec4> tangents;
    for (std::size_t face = 0; face < from.triangleCount(); ++face) {
        const std::size_t index = bake.first_triangle[s][p] + face;
        const auto corners = coordinatesOf(group, index);
        const TriangleFrame frame =
            frameOf(source, group.triangles[index], group.atlas.places[index].turned);
        for (std::size_t k = 0; k < 3; ++k) {
            geometry->indices.push_back(static_cast<std::uint32_t>(geometry->positions.size()));
            geometry->positions.push_back(from.positions[from.indices[3 * face + k]]);
            uv.push_back(corners[k]);
            normals.push_back(frame.normals[k]);
            tangents.push_back(frame.tangents[k]);
        }
    }
    if (group.normals || findAttribute(from.attributes, "NORMAL"))
        geometry->attributes.push_back(floatAttribute("NORMAL", normals));
    if (group.normals)
        geometry->attributes.push_back(floatAttribute("TANGENT", tangents));
    geometry->attributes.push_back(floatAttribute("TEXCOORD_0", uv));
    return geometry;
}

// Makes a group's material with its atlases. Returns its number.
std::uint32_t addMaterial(SceneBuilder& builder, const BakedGroup& group, AtlasImages images) {
    std::array<TextureRef, 4> refs;
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (!images[i].bytes)
            continue;
        refs[i].image = builder.addImage(std::move(images[i]));
        refs[i].wrap_u = refs[i].wrap_v = TextureWrap::ClampToEdge;
    }
    Material material = group.material;
    material.base_color = glm::vec4(1.0f);
    material.base_color_texture = refs[0];
    material.normal_texture = refs[1];
    material.normal_scale = 1.0f;
    material.metallic_roughness_texture = refs[2];
    material.occlusion_texture = refs[2];
    material.occlusion_strength = 1.0f;
    material.emissive_texture = refs[3];
    if (group.surface)
        material.metallic = material.roughness = 1.0f;
    if (group.emission)
        material.emissive = glm::vec3(1.0f);
    return builder.addMaterial(std::move(material));
}

// Whether the texture coordinates that are left show no less than the atlases, and cost no more.
bool keepsTextures(const Bake& bake,
                   const BakedGroup& group,
                   const BakedPixels& pixels,
                   const AtlasImages& atlases,
                   const TextureSampler& sampler) {
    if (originalBytes(bake.scene, group) > bytesOf(atlases))
        return false;
    const TextureErrors errors = textureErrors(group, pixels, bake.sources, sampler);
    return errors.kept <= errors.baked;
}

// The original's materials as far as primitives go on using them.
class OldMaterials {
public:
    OldMaterials(const Scene& scene, SceneBuilder& builder) : scene_(scene), builder_(builder) {}

    // Of untextured primitives: its textures are not used by anything.
    std::uint32_t plain(std::uint32_t material) {
        return copied(material, plain_, [](TextureRef& texture) { texture = {}; });
    }

    std::uint32_t textured(std::uint32_t material) {
        return copied(material, textured_, [this](TextureRef& texture) {
            if (texture.image >= scene_.images.size())
                return;
            const auto [found, fresh] = images_.try_emplace(texture.image, 0);
            if (fresh)
                found->second = builder_.addImage(scene_.images[texture.image]);
            texture.image = found->second;
        });
    }

private:
    using Numbers = std::map<std::uint32_t, std::uint32_t>;

    template <class Adapt>
    std::uint32_t copied(std::uint32_t material, Numbers& copies, Adapt adapt) {
        if (material == kNone)
            return kNone;
        const auto [found, fresh] = copies.try_emplace(material, 0);
        if (fresh) {
            Material copy = scene_.materials[material];
            for (const auto slot : kTextureSlots)
                adapt(copy.*slot);
            found->second = builder_.addMaterial(std::move(copy));
        }
        return found->second;
    }

    const Scene& scene_;
    SceneBuilder& builder_;
    Numbers plain_;
    Numbers textured_;
    Numbers images_;
};

// material_of_group: nullopt: its primitives keep their textures.
void addSubmeshes(const Bake& bake,
                  const Lod& lod,
                  std::span<const std::optional<std::uint32_t>> material_of_group,
                  SceneBuilder& builder) {
    OldMaterials old(bake.scene, builder);
    for (std::uint32_t s = 0; s < bake.scene.submeshes.size(); ++s) {
        Submesh submesh = bake.scene.submeshes[s];
        for (std::uint32_t p = 0; p < submesh.primitives.size(); ++p) {
            Primitive& primitive = submesh.primitives[p];
            const std::size_t group = bake.primitive_group[s][p];
            const bool plain = group == Bake::kPlain;
            if (plain || !material_of_group[group]) {
                primitive.geometry = lod.submeshes[s].primitives[p];
                primitive.material =
                    plain ? old.plain(primitive.material) : old.textured(primitive.material);
                continue;
            }
            primitive.geometry = unfold(bake, s, p);
            primitive.material = *material_of_group[group];
            primitive.position_type = ComponentType::Float32;
            primitive.position_normalized = false;
        }
        std::erase_if(submesh.primitives, [](const Primitive& primitive) {
            return primitive.geometry->indices.empty() &&
                   primitive.mode == PrimitiveMode::Triangles;
        });
        builder.addSubmesh(std::move(submesh));
    }
}

void addInstances(const Scene& scene, const Lod& lod, SceneBuilder& builder) {
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    for (std::uint32_t s = 0; s < ranges.size(); ++s)
        for (std::uint32_t k = 0; k < lod.submeshes[s].kept_instances; ++k) {
            const auto& order = lod.submeshes[s].instance_order;
            const Instance& instance = scene.instances[order ? (*order)[k] : ranges[s].begin + k];
            const std::string& name =
                instance.node == kNone ? scene.name : scene.nodes[instance.node].name;
            builder.addNode(name, kNone, instance.transform, s);
        }
    for (const Camera& camera : scene.cameras)
        builder.addCamera(camera, builder.addNode(camera.name, kNone, camera.world));
}

bool hasMotion(const Scene& scene) {
    return std::ranges::any_of(
        scene.nodes, [](const Node& node) { return node.animated || node.skin != kNone; });
}

Result<std::vector<BakedPixels>>
bakeGroups(const Bake& bake, const TextureSampler& sampler, const JobContext& job) {
    std::size_t triangles = 0;
    for (const BakedGroup& group : bake.groups)
        triangles += group.triangles.size();
    std::atomic<std::size_t> finished{0};
    const auto done = [&](std::size_t count) {
        const std::size_t so_far = finished += count;
        if (count > 0)
            job.report(static_cast<double>(so_far) / static_cast<double>(triangles));
        return !job.stopRequested();
    };
    std::vector<BakedPixels> all;
    for (const BakedGroup& group : bake.groups) {
        Result<BakedPixels> pixels = bakePixels(group, bake.sources, sampler, bake.options, done);
        if (!pixels)
            return tl::unexpected(pixels.error());
        all.push_back(std::move(*pixels));
    }
    return all;
}

// What is told of a group's atlas; its material is not known yet.
BakedAtlas describeAtlas(const Bake& bake, const BakedGroup& group, const TextureImages& images) {
    BakedAtlas atlas;
    atlas.texels_per_unit = group.atlas.texels_per_unit;
    TexelArea covered;
    for (const BakedPart& part : group.parts) {
        const Primitive& primitive = bake.scene.submeshes[part.submesh].primitives[part.primitive];
        if (primitive.material == kNone)
            continue;
        const Material& material = bake.scene.materials[primitive.material];
        const TextureRef& texture = material.base_color_texture;
        if (images.covers(*primitive.geometry, texture))
            covered.add(*primitive.geometry,
                        texture,
                        images.size(texture.image),
                        bake.sources[part.submesh].stretch);
        if (atlas.original_image == kNone)
            atlas.original_image = material.base_color_texture.image;
    }
    atlas.original_texels_per_unit = covered.texelsPerUnit();
    return atlas;
}

} // namespace

bool isBaked(const Scene& scene, const Primitive& primitive) {
    if (primitive.mode != PrimitiveMode::Triangles)
        return false;
    if (primitive.material != kNone && hasTexture(scene.materials[primitive.material]))
        return true;
    return findAttribute(primitive.geometry->attributes, "COLOR_0") != nullptr;
}

Result<BakedScene> bakeTextures(const Scene& scene,
                                const Lod& lod,
                                std::span<const BakeSubmesh> submeshes,
                                const BakeOptions& options,
                                const JobContext& job) {
    Bake bake{scene, options, {}, {}, {}, {}, {}};
    if (const Result<void> read = readSources(bake, submeshes, job); !read)
        return tl::unexpected(read.error());
    makeGroups(bake);
    if (const Result<void> packed = packGroups(bake); !packed)
        return tl::unexpected(packed.error());
    const TextureSampler sampler(scene);
    const Result<std::vector<BakedPixels>> pixels = bakeGroups(bake, sampler, job);
    if (!pixels)
        return tl::unexpected(pixels.error());
    SceneBuilder builder(scene.name);
    std::vector<std::optional<std::uint32_t>> material_of_group;
    BakedScene baked;
    for (std::size_t g = 0; g < bake.groups.size(); ++g) {
        const BakedGroup& group = bake.groups[g];
        Result<AtlasImages> images = encodeAtlases(scene, group, (*pixels)[g], options);
        if (!images)
            return tl::unexpected(images.error());
        material_of_group.emplace_back();
        if (options.keep_better && keepsTextures(bake, group, (*pixels)[g], *images, sampler)) {
            baked.notes.push_back("material '" + group.material.name +
                                  "' keeps its textures: they show the original no worse than an "
                                  "atlas of " +
                                  std::to_string(group.atlas.size_px) + " pixels");
            continue;
        }
        material_of_group.back() = addMaterial(builder, group, std::move(*images));
        baked.atlases.push_back(describeAtlas(bake, group, sampler.images()));
        baked.atlases.back().material = *material_of_group.back();
    }
    for (const BakedAtlas& atlas : baked.atlases)
        baked.texels_per_unit = baked.texels_per_unit > 0.0
                                    ? std::min(baked.texels_per_unit, atlas.texels_per_unit)
                                    : atlas.texels_per_unit;
    addSubmeshes(bake, lod, material_of_group, builder);
    addInstances(scene, lod, builder);
    builder.setFileBytes(scene.file_bytes);
    std::ranges::copy(sampler.notes(), std::back_inserter(baked.notes));
    if (hasMotion(scene))
        baked.notes.emplace_back("animations and skins are left out of transferred textures");
    baked.scene = builder.finish();
    return baked;
}

} // namespace lodestone
