#include "simplify/measure/vertex_distance.h"

#include "simplify/measure/closest_surface.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::uint32_t kBlockVertices = 256; // measured together; neighbours are quick

// Some vertices of a primitive, at all instances that count.
struct Block {
    VertexDistances* result = nullptr;
    const std::vector<const SurfacePiece*>* pieces = nullptr; // of the primitive
    const std::vector<std::uint32_t>* vertices = nullptr;     // used by triangles
    std::size_t begin = 0;
    std::size_t end = 0;
};

struct MeasuredPrimitive {
    VertexDistances* result = nullptr;
    std::vector<const SurfacePiece*> pieces; // one an instance
    std::vector<std::uint32_t> vertices;
};

std::vector<std::uint32_t> usedVertices(const Geometry& geometry) {
    std::vector<bool> used(geometry.positions.size());
    for (const std::uint32_t index : geometry.indices)
        used[index] = true;
    std::vector<std::uint32_t> vertices;
    for (std::uint32_t v = 0; v < used.size(); ++v)
        if (used[v])
            vertices.push_back(v);
    return vertices;
}

void measureBlock(const Block& block, const ClosestSurface& to, const JobContext& job) {
    const std::size_t count = block.end - block.begin;
    std::vector<double> max(count);
    std::vector<double> sum(count);
    for (const SurfacePiece* piece : *block.pieces) {
        if (job.stopRequested())
            return;
        ClosestSurface::Cursor cursor(to);
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec3 point = piece->corner((*block.vertices)[block.begin + i]);
            if (isFar(point))
                continue;
            const double distance = cursor.closest(point).distance;
            max[i] = std::max(max[i], distance);
            sum[i] += distance;
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t vertex = (*block.vertices)[block.begin + i];
        block.result->max[vertex] = static_cast<float>(100.0 * max[i]);
        block.result->mean[vertex] =
            static_cast<float>(100.0 * sum[i] / static_cast<double>(block.pieces->size()));
    }
}

// Every primitive with triangles, with the pieces that draw it; sizes the field.
std::vector<MeasuredPrimitive>
primitivesOf(std::span<const SurfacePiece> pieces, const Lod& lod, VertexDistanceField& field) {
    std::vector<MeasuredPrimitive> primitives;
    field.resize(lod.submeshes.size());
    std::vector<std::vector<std::size_t>> place(lod.submeshes.size());
    for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
        field[s].resize(lod.submeshes[s].primitives.size());
        place[s].assign(field[s].size(), SIZE_MAX);
    }
    for (const SurfacePiece& piece : pieces) {
        std::size_t& at = place[piece.submesh][piece.primitive];
        if (at == SIZE_MAX) {
            at = primitives.size();
            VertexDistances& result = field[piece.submesh][piece.primitive];
            result.max.assign(piece.geometry->positions.size(), 0.0f);
            result.mean = result.max;
            primitives.push_back({&result, {}, usedVertices(*piece.geometry)});
        }
        primitives[at].pieces.push_back(&piece);
    }
    return primitives;
}

// Leaves every k-th instance so that all together are about as many points as wanted.
void thinOut(std::vector<MeasuredPrimitive>& primitives, std::uint64_t points) {
    std::uint64_t all = 0;
    for (const MeasuredPrimitive& primitive : primitives)
        all += primitive.vertices.size() * primitive.pieces.size();
    const std::uint64_t step = (all + points - 1) / points;
    for (MeasuredPrimitive& primitive : primitives) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < primitive.pieces.size(); i += step)
            primitive.pieces[kept++] = primitive.pieces[i];
        primitive.pieces.resize(kept);
    }
}

} // namespace

Result<VertexDistanceField> measureVertexDistances(const LodView& view,
                                                   const LodView& reference,
                                                   const VertexDistanceOptions& options,
                                                   const JobContext& job) {
    if (options.points < 1)
        return fail(ErrorKind::Usage, "vertex distances: the number of points must be 1 or more");
    const Result<SurfaceFrame> frame = frameOf(*reference.scene);
    if (!frame)
        return tl::unexpected(frame.error());
    const std::vector<SurfacePiece> target = surfacePieces(reference, *frame);
    const Result<ClosestSurface> surface = ClosestSurface::build(target, job);
    if (!surface)
        return tl::unexpected(surface.error());
    const std::vector<SurfacePiece> pieces = surfacePieces(view, *frame);
    VertexDistanceField field;
    std::vector<MeasuredPrimitive> primitives = primitivesOf(pieces, *view.lod, field);
    thinOut(primitives, options.points);
    std::vector<Block> blocks;
    for (const MeasuredPrimitive& primitive : primitives)
        for (std::size_t begin = 0; begin < primitive.vertices.size(); begin += kBlockVertices)
            blocks.push_back(
                {primitive.result,
                 &primitive.pieces,
                 &primitive.vertices,
                 begin,
                 std::min<std::size_t>(begin + kBlockVertices, primitive.vertices.size())});
    tbb::parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t i) {
        measureBlock(blocks[i], *surface, job);
    });
    if (job.stopRequested())
        return cancelled();
    job.report(1.0);
    return field;
}

} // namespace lodestone
