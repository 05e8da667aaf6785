#include "bench/peers/reduce_scene.h"

#include "bench/peers/nearest.h"
#include "scene/finite.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace lodestone::bench {

namespace {

std::vector<std::byte> gathered(const Attribute& attribute,
                                std::span<const std::uint32_t> vertices) {
    const std::size_t stride = attribute.stride();
    std::vector<std::byte> bytes(vertices.size() * stride);
    for (std::size_t i = 0; i < vertices.size(); ++i)
        std::memcpy(
            bytes.data() + i * stride, attribute.bytes.data() + vertices[i] * stride, stride);
    return bytes;
}

void gather(std::vector<Attribute>& attributes, std::span<const std::uint32_t> vertices) {
    for (Attribute& attribute : attributes)
        attribute.bytes = gathered(attribute, vertices);
}

// Drops vertices that no triangle uses. Returns what is left, in order of first use.
std::vector<std::uint32_t> compact(PeerMesh& mesh) {
    std::vector<std::uint32_t> place(mesh.positions.size(), kNone);
    std::vector<std::uint32_t> kept;
    for (std::uint32_t& index : mesh.indices) {
        if (place[index] == kNone) {
            place[index] = static_cast<std::uint32_t>(kept.size());
            kept.push_back(index);
        }
        index = place[index];
    }
    std::vector<glm::vec3> positions;
    positions.reserve(kept.size());
    for (const std::uint32_t vertex : kept)
        positions.push_back(mesh.positions[vertex]);
    mesh.positions = std::move(positions);
    return kept;
}

} // namespace

std::string faultOf(const PeerMesh& mesh) {
    if (mesh.indices.size() % 3 != 0)
        return "its indices are not triangles";
    if (!std::ranges::all_of(mesh.positions, [](const glm::vec3& p) { return isFinite(p); }))
        return "a position is not finite";
    if (std::ranges::any_of(mesh.indices,
                            [&](std::uint32_t index) { return index >= mesh.positions.size(); }))
        return "an index is out of range";
    return {};
}

PeerMesh weldedMesh(const Geometry& geometry) {
    std::vector<std::uint32_t> order(geometry.positions.size());
    for (std::uint32_t vertex = 0; vertex < order.size(); ++vertex)
        order[vertex] = vertex;
    const auto key = [&](std::uint32_t vertex) {
        const glm::vec3& p = geometry.positions[vertex];
        return std::array{p.x, p.y, p.z};
    };
    std::ranges::stable_sort(order, std::ranges::less(), key);
    PeerMesh welded;
    std::vector<std::uint32_t> place(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || key(order[i]) != key(order[i - 1]))
            welded.positions.push_back(geometry.positions[order[i]]);
        place[order[i]] = static_cast<std::uint32_t>(welded.positions.size() - 1);
    }
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        const std::array corners{place[geometry.indices[i]],
                                 place[geometry.indices[i + 1]],
                                 place[geometry.indices[i + 2]]};
        if (corners[0] != corners[1] && corners[1] != corners[2] && corners[2] != corners[0])
            welded.indices.insert(welded.indices.end(), corners.begin(), corners.end());
    }
    compact(welded);
    return welded;
}

namespace {

std::vector<float> attributeValues(const Geometry& geometry) {
    std::vector<float> values(PeerWeights::kValues * geometry.positions.size(), 0.0f);
    const auto fill = [&](std::string_view semantic, std::size_t offset, std::size_t components) {
        const Attribute* attribute = findAttribute(geometry.attributes, semantic);
        if (attribute == nullptr || attribute->components < components)
            return;
        for (std::size_t v = 0; v < geometry.positions.size(); ++v)
            for (std::size_t c = 0; c < components; ++c)
                values[PeerWeights::kValues * v + offset + c] = attributeValue(*attribute, v, c);
    };
    fill("NORMAL", 0, 3);
    fill("COLOR_0", 3, 3);
    fill("TEXCOORD_0", 6, 2);
    return values;
}

} // namespace

PeerInput::PeerInput(const Scene& scene, Welding welding, double ratio)
    : scene_(&scene), welding_(welding) {
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    for (std::uint32_t s = 0; s < ranges.size(); ++s)
        for (std::uint32_t p = 0; p < scene.submeshes[s].primitives.size(); ++p) {
            const Primitive& primitive = scene.submeshes[s].primitives[p];
            const Geometry& stored = *primitive.geometry;
            if (primitive.mode != PrimitiveMode::Triangles || ranges[s].size() == 0 ||
                stored.indices.empty())
                continue;
            Part part{s, p, {}, 0};
            part.mesh = welding == Welding::Positions
                            ? weldedMesh(stored)
                            : PeerMesh{stored.positions, stored.indices, attributeValues(stored)};
            part.triangle_target = static_cast<std::size_t>(
                std::ceil(ratio * static_cast<double>(stored.triangleCount())));
            if (!part.mesh.indices.empty())
                parts_.push_back(std::move(part));
        }
}

GeometryPtr PeerInput::toGeometry(const Part& part, PeerMesh mesh) const {
    const Geometry& stored = *scene_->submeshes[part.submesh].primitives[part.primitive].geometry;
    std::vector<std::uint32_t> source = compact(mesh);
    if (welding_ == Welding::Positions) {
        const NearestPoint nearest(stored.positions);
        for (std::size_t vertex = 0; vertex < source.size(); ++vertex)
            source[vertex] = nearest(mesh.positions[vertex]);
    }
    auto made = std::make_shared<Geometry>();
    made->positions = std::move(mesh.positions);
    made->indices = std::move(mesh.indices);
    made->attributes = stored.attributes;
    made->morph_targets = stored.morph_targets;
    gather(made->attributes, source);
    for (MorphTarget& target : made->morph_targets)
        gather(target.attributes, source);
    return made;
}

Lod PeerInput::toLod(std::vector<PeerMesh> meshes) const {
    Lod lod = fullLod(*scene_);
    for (std::size_t i = 0; i < parts_.size(); ++i)
        lod.submeshes[parts_[i].submesh].primitives[parts_[i].primitive] =
            toGeometry(parts_[i], std::move(meshes[i]));
    lod.triangles = lod.unique_triangles = lod.instances = 0;
    for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
        LodSubmesh& submesh = lod.submeshes[s];
        std::uint64_t triangles = 0;
        std::uint64_t indices = 0;
        for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
            indices += submesh.primitives[p]->indices.size();
            if (scene_->submeshes[s].primitives[p].mode == PrimitiveMode::Triangles)
                triangles += submesh.primitives[p]->triangleCount();
        }
        if (indices == 0)
            submesh.kept_instances = 0;
        lod.triangles += triangles * submesh.kept_instances;
        lod.unique_triangles += submesh.kept_instances > 0 ? triangles : 0;
        lod.instances += submesh.kept_instances;
    }
    return lod;
}

Result<ReducedScene> PeerInput::reduce(const MeshPeer& peer) const {
    std::vector<Job> jobs;
    for (const Part& part : parts_)
        jobs.push_back({&part.mesh, part.triangle_target});
    Result<Reduced> reduced = peer.simplify(jobs);
    if (!reduced)
        return tl::unexpected(reduced.error());
    for (const PeerMesh& mesh : reduced->meshes)
        if (const std::string fault = faultOf(mesh); !fault.empty())
            return fail(ErrorKind::Failed, peer.name + ": " + fault);
    return ReducedScene{toLod(std::move(reduced->meshes)), reduced->seconds};
}

} // namespace lodestone::bench
