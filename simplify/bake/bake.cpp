#include "simplify/bake/bake.h"

#include "scene/scene_builder.h"
#include "simplify/bake/baked_group.h"
#include "simplify/bake/encoded_atlas.h"
#include "simplify/bake/texel_density.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <map>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

bool hasTexture(const Material& material) {
    return std::ranges::any_of(std::array{&material.base_color_texture,
                                          &material.metallic_roughness_texture,
                                          &material.normal_texture,
                                          &material.occlusion_texture,
                                          &material.emissive_texture},
                               [](const TextureRef* texture) { return texture->image != kNone; });
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
        bake.groups.emplace_back();
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

// The images of a group's atlases: colour, normal, surface, emission; none where it has no pixels.
Result<std::array<TextureRef, 4>> addImages(const Bake& bake,
                                            SceneBuilder& builder,
                                            const BakedGroup& group,
                                            const BakedPixels& pixels,
                                            const std::string& stem) {
    struct Job {
        std::string name;
        const std::vector<std::uint8_t>* rgba;
        std::vector<TextureRef Material::*> slots;
        Result<Image> image;
    };

    const bool opaque = group.material.alpha_mode == AlphaMode::Opaque;
    std::array<Job, 4> jobs{
        Job{stem + "_color", &pixels.base_color, {&Material::base_color_texture}, {}},
        Job{stem + "_normal", &pixels.normal, {&Material::normal_texture}, {}},
        Job{stem + "_surface",
            &pixels.surface,
            {&Material::metallic_roughness_texture, &Material::occlusion_texture},
            {}},
        Job{stem + "_emission", &pixels.emissive, {&Material::emissive_texture}, {}}};
    tbb::parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t i) {
        if (jobs[i].rgba->empty())
            return;
        const bool alpha = i == 0 && !opaque;
        const AtlasPixels atlas{*jobs[i].rgba,
                                group.atlas.size_px,
                                alpha ? Channels::Rgba : Channels::Rgb,
                                isFromJpeg(bake.scene, group, jobs[i].slots)};
        jobs[i].image = encodedAtlas(jobs[i].name, atlas, bake.options);
    });
    std::array<TextureRef, 4> refs;
    for (std::size_t i = 0; i < jobs.size(); ++i) {
        if (!jobs[i].image)
            return tl::unexpected(jobs[i].image.error());
        if (jobs[i].rgba->empty())
            continue;
        refs[i].image = builder.addImage(std::move(*jobs[i].image));
        refs[i].wrap_u = refs[i].wrap_v = TextureWrap::ClampToEdge;
    }
    return refs;
}

// Encodes a group's atlases and makes its material.
Result<Material> addMaterial(const Bake& bake,
                             SceneBuilder& builder,
                             const BakedPixels& pixels,
                             std::size_t number) {
    const BakedGroup& group = bake.groups[number];
    Material material = group.material;
    const std::string stem =
        material.name.empty() ? "atlas" + std::to_string(number) : material.name;
    const Result<std::array<TextureRef, 4>> images = addImages(bake, builder, group, pixels, stem);
    if (!images)
        return tl::unexpected(images.error());
    const std::array<TextureRef, 4>& refs = *images;
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
    return material;
}

// Materials of untextured primitives as they were; their textures are not used by anything.
std::uint32_t plainMaterial(const Bake& bake,
                            SceneBuilder& builder,
                            std::map<std::uint32_t, std::uint32_t>& copies,
                            std::uint32_t material) {
    if (material == kNone)
        return kNone;
    const auto [found, fresh] = copies.try_emplace(material, 0);
    if (fresh) {
        Material copy = bake.scene.materials[material];
        copy.base_color_texture = copy.normal_texture = copy.occlusion_texture = {};
        copy.metallic_roughness_texture = copy.emissive_texture = {};
        found->second = builder.addMaterial(std::move(copy));
    }
    return found->second;
}

void addSubmeshes(const Bake& bake,
                  const Lod& lod,
                  std::span<const std::uint32_t> material_of_group,
                  SceneBuilder& builder) {
    std::map<std::uint32_t, std::uint32_t> copies;
    for (std::uint32_t s = 0; s < bake.scene.submeshes.size(); ++s) {
        Submesh submesh = bake.scene.submeshes[s];
        for (std::uint32_t p = 0; p < submesh.primitives.size(); ++p) {
            Primitive& primitive = submesh.primitives[p];
            const std::size_t group = bake.primitive_group[s][p];
            if (group == Bake::kPlain) {
                primitive.geometry = lod.submeshes[s].primitives[p];
                primitive.material = plainMaterial(bake, builder, copies, primitive.material);
                continue;
            }
            primitive.geometry = unfold(bake, s, p);
            primitive.material = material_of_group[group];
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
    std::vector<std::uint32_t> material_of_group;
    BakedScene baked;
    for (std::size_t g = 0; g < bake.groups.size(); ++g) {
        Result<Material> material = addMaterial(bake, builder, (*pixels)[g], g);
        if (!material)
            return tl::unexpected(material.error());
        material_of_group.push_back(builder.addMaterial(std::move(*material)));
        baked.atlases.push_back(describeAtlas(bake, bake.groups[g], sampler.images()));
        baked.atlases.back().material = material_of_group.back();
        const double density = bake.groups[g].atlas.texels_per_unit;
        baked.texels_per_unit = g == 0 ? density : std::min(baked.texels_per_unit, density);
    }
    addSubmeshes(bake, lod, material_of_group, builder);
    addInstances(scene, lod, builder);
    builder.setFileBytes(scene.file_bytes);
    baked.notes = sampler.notes();
    if (hasMotion(scene))
        baked.notes.emplace_back("animations and skins are left out of transferred textures");
    baked.scene = builder.finish();
    return baked;
}

} // namespace lodestone
