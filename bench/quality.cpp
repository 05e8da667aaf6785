#include "bench/quality.h"

#include "simplify/measure/surface_samples.h"
#include "simplify/measure/vertex_distance.h"

#include <algorithm>

namespace lodestone::bench {

Result<Distance> distanceToFull(const LodView& lod) {
    const Lod full = fullLod(*lod.scene);
    return measureDistance({lod.scene, &full}, lod, {}, {});
}

namespace {

Result<double> farthestVertexOf(const LodView& view, const LodView& reference) {
    const Result<VertexDistanceField> field =
        measureVertexDistances(view, reference, {300'000}, {});
    if (!field)
        return tl::unexpected(field.error());
    double farthest = 0.0;
    for (const std::vector<VertexDistances>& submesh : *field)
        for (const VertexDistances& primitive : submesh)
            for (const float distance : primitive.max)
                farthest = std::max(farthest, static_cast<double>(distance));
    return farthest;
}

} // namespace

Result<double> farthestVertex(const LodView& lod) {
    const Lod full = fullLod(*lod.scene);
    const LodView all{lod.scene, &full};
    const Result<double> there = farthestVertexOf(lod, all);
    const Result<double> back = farthestVertexOf(all, lod);
    if (!there || !back)
        return there ? back : there;
    return std::max(*there, *back);
}

namespace {

Result<double> areaOfLod(const LodView& lod, const SurfaceFrame& frame) {
    const std::vector<SurfacePiece> pieces = surfacePieces(lod, frame);
    const Result<SurfaceSampler> sampler = SurfaceSampler::build(pieces, {});
    if (!sampler)
        return tl::unexpected(sampler.error());
    return sampler->area();
}

} // namespace

Result<double> areaLeft(const LodView& lod) {
    const Result<SurfaceFrame> frame = frameOf(*lod.scene);
    if (!frame)
        return tl::unexpected(frame.error());
    const Lod full = fullLod(*lod.scene);
    const Result<double> before = areaOfLod({lod.scene, &full}, *frame);
    const Result<double> after = areaOfLod(lod, *frame);
    if (!before || !after)
        return before ? after : before;
    return *after / *before;
}

Lod lodAtTriangles(const LodSource& source, double triangles) {
    const ByteModel bytes(source.scene(), ExportOptions{});
    const Resolved at = source.resolve({Target::Kind::Triangles, triangles}, bytes);
    return source.readOut(at.position, nullptr);
}

std::vector<std::uint64_t> trianglesBySubmesh(const Lod& lod) {
    std::vector<std::uint64_t> counts;
    for (const LodSubmesh& submesh : lod.submeshes) {
        std::uint64_t triangles = 0;
        for (const GeometryPtr& geometry : submesh.primitives)
            triangles += geometry->triangleCount();
        counts.push_back(triangles);
    }
    return counts;
}

Losses lossesOf(const Scene& scene, const Lod& lod, std::span<const std::uint64_t> floors) {
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    const std::vector<std::uint64_t> triangles = trianglesBySubmesh(lod);
    Losses losses;
    for (std::size_t s = 0; s < ranges.size(); ++s) {
        if (ranges[s].size() == 0 || triangleCount(scene.submeshes[s]) == 0)
            continue;
        const std::uint32_t kept = lod.submeshes[s].kept_instances;
        if (triangles[s] == 0 || kept == 0)
            ++losses.vanished_submeshes;
        if (triangles[s] > floors[s])
            losses.early_instances += ranges[s].size() - kept;
    }
    return losses;
}

} // namespace lodestone::bench
