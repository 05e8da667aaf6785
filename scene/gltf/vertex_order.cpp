#include "scene/gltf/vertex_order.h"

#include <algorithm>
#include <cstring>
#include <meshoptimizer.h>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

Attribute reordered(const Attribute& from, std::span<const std::uint32_t> new_place) {
    Attribute to = from;
    const std::size_t stride = from.stride();
    for (std::size_t v = 0; v < new_place.size(); ++v)
        std::memcpy(
            to.bytes.data() + new_place[v] * stride, from.bytes.data() + v * stride, stride);
    return to;
}

// New place of each vertex: in the order of the indices, unused ones after that.
std::vector<std::uint32_t> fetchOrder(std::span<const std::uint32_t> indices, std::size_t count) {
    std::vector<std::uint32_t> new_place(count, kNone);
    std::uint32_t next = 0;
    for (const std::uint32_t index : indices)
        if (new_place[index] == kNone)
            new_place[index] = next++;
    for (std::uint32_t& place : new_place)
        if (place == kNone)
            place = next++;
    return new_place;
}

GeometryPtr inFetchOrder(const Geometry& from) {
    auto to = std::make_shared<Geometry>();
    const std::size_t count = from.positions.size();
    to->indices.resize(from.indices.size());
    meshopt_optimizeVertexCacheStrip(
        to->indices.data(), from.indices.data(), from.indices.size(), count);
    const std::vector<std::uint32_t> new_place = fetchOrder(to->indices, count);
    for (std::uint32_t& index : to->indices)
        index = new_place[index];
    to->positions.resize(count);
    for (std::size_t v = 0; v < count; ++v)
        to->positions[new_place[v]] = from.positions[v];
    for (const Attribute& attribute : from.attributes)
        to->attributes.push_back(reordered(attribute, new_place));
    for (const MorphTarget& target : from.morph_targets) {
        to->morph_targets.emplace_back();
        for (const Attribute& attribute : target.attributes)
            to->morph_targets.back().attributes.push_back(reordered(attribute, new_place));
    }
    return to;
}

// How many accessors of the unchanged scene hold each content.
std::vector<std::uint32_t> contentUses(const ExportPlan& plan) {
    std::vector<std::uint32_t> uses(plan.content_count, 0);
    for (const MeshPlan& mesh : plan.meshes)
        for (const PrimitivePlan& primitive : mesh.primitives) {
            for (const StreamPlan& stream : primitive.streams)
                ++uses[stream.content];
            ++uses[primitive.index_content];
        }
    return uses;
}

bool isShared(const PrimitivePlan& primitive, std::span<const std::uint32_t> uses) {
    return uses[primitive.index_content] > 1 ||
           std::ranges::any_of(primitive.streams,
                               [&](const StreamPlan& stream) { return uses[stream.content] > 1; });
}

bool hasTriangles(const Primitive& primitive, const Geometry& geometry) {
    return primitive.mode == PrimitiveMode::Triangles && !geometry.indices.empty();
}

} // namespace

Lod inFetchOrder(const ExportPlan& plan, const Lod& lod, const LodShape& shape) {
    Lod ordered = lod;
    const std::vector<std::uint32_t> uses = contentUses(plan);
    tbb::parallel_for(std::size_t{0}, ordered.submeshes.size(), [&](std::size_t s) {
        const MeshPlan& mesh = plan.meshes[plan.submeshes[s].mesh];
        std::vector<GeometryPtr>& primitives = ordered.submeshes[s].primitives;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const bool keeps = !shape.submeshes[s].changed && isShared(mesh.primitives[p], uses);
            if (!keeps && hasTriangles(plan.scene.submeshes[s].primitives[p], *primitives[p]))
                primitives[p] = inFetchOrder(*primitives[p]);
        }
    });
    return ordered;
}

} // namespace lodestone
