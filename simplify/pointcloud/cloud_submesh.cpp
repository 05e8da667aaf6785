#include "simplify/pointcloud/cloud_submesh.h"

#include "simplify/pointcloud/advancing_front.h"
#include "simplify/pointcloud/cloud_read_out.h"
#include "simplify/pointcloud/retriangulate.h"
#include "simplify/stretch.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

double farthestMove(const CloudSurface& surface, const Complex& complex) {
    double farthest2 = 0.0;
    for (std::size_t v = 0; v < surface.stands_for.size(); ++v) {
        if (surface.stands_for[v] == kNone)
            continue;
        const glm::dvec3 move =
            surface.positions[surface.stands_for[v]] - glm::dvec3(complex.positions[v]);
        farthest2 = std::max(farthest2, glm::dot(move, move));
    }
    return std::max(std::sqrt(farthest2), surface.removal_error);
}

ShapeMeasure measure(const CloudSurface& surface) {
    ShapeMeasure measured;
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
        measured.add(surface.points(f));
    return measured;
}

// Side of the equilateral triangle of mean area.
double typicalEdge(const CloudSubmesh& submesh) {
    const auto count = static_cast<double>(std::max<std::size_t>(1, submesh.surface.faces.size()));
    return std::sqrt(4.0 / std::sqrt(3.0) * submesh.shape.area / count);
}

} // namespace

CloudSubmesh makeCloudSubmesh(const Submesh& submesh,
                              std::span<const Instance> instances,
                              const JobContext& job) {
    CloudSubmesh made;
    made.submesh = &submesh;
    made.triangles = static_cast<std::uint32_t>(triangleCount(submesh));
    made.instances = static_cast<std::uint32_t>(instances.size());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        if (stopsAt(i, job))
            return made;
        made.stretch = std::max(made.stretch, longestStretch(glm::dmat3(instances[i].transform)));
    }
    if (made.stretch <= 0.0)
        return made;
    made.complex = buildComplex(submesh, job);
    if (job.stopRequested())
        return made;
    made.surface = makeSurface(submesh, made.complex, job);
    if (job.stopRequested())
        return made;
    made.shape = measure(made.surface);
    made.edge_length = typicalEdge(made);
    return made;
}

bool keepsFloor(const CloudSubmesh& from, const CloudDraft& draft, CloudFloor floor) {
    if (!draft.surface)
        return true;
    if (draft.triangles < std::min<std::size_t>(4, from.surface.faces.size()))
        return false;
    constexpr ShapeShares kLeast{0.4, 0.0}; // a road's slab below that is under the grass
    return floor == CloudFloor::Triangles || from.instances < 2 ||
           keepsShape(measure(*draft.surface), from.shape, kLeast);
}

CloudDraft originalDraft(const CloudSubmesh& from) {
    CloudDraft draft;
    for (const Primitive& primitive : from.submesh->primitives)
        draft.shape.push_back({static_cast<std::uint32_t>(primitive.geometry->positions.size()),
                               static_cast<std::uint32_t>(primitive.geometry->indices.size())});
    draft.triangles = from.triangles;
    return draft;
}

CloudDraft draftPiece(const CloudSubmesh& from,
                      const CloudMethod& method,
                      const CloudSettings& settings,
                      const JobContext& job) {
    if (job.stopRequested())
        return originalDraft(from);
    auto surface = std::make_shared<CloudSurface>(from.surface);
    method.run(*surface, from.complex, settings, job);
    const auto is_changed = [](std::uint8_t flag) { return flag != 0; };
    if (job.stopRequested() || (surface->faces.size() == from.surface.faces.size() &&
                                std::ranges::none_of(surface->changed, is_changed)))
        return originalDraft(from);
    if (settings.retriangulation == Retriangulation::PointCloud)
        rebuildFromPoints(*surface);
    CloudDraft draft;
    draft.shape = shapeOfSurface(*surface, *from.submesh, from.complex);
    draft.triangles = static_cast<std::uint32_t>(surface->faces.size());
    draft.error = farthestMove(*surface, from.complex);
    draft.surface = std::move(surface);
    return draft;
}

CloudPiece finishPiece(const CloudSubmesh& from, const CloudDraft& draft, const JobContext& job) {
    CloudPiece piece;
    piece.triangles = draft.triangles;
    piece.error = draft.error;
    piece.changed = draft.surface != nullptr;
    if (!piece.changed) {
        for (const Primitive& primitive : from.submesh->primitives)
            piece.primitives.push_back(primitive.geometry);
        return piece;
    }
    if (job.stopRequested())
        return piece;
    CloudSurface surface = *draft.surface;
    if (!surface.from_points)
        flipToDelaunay(surface, job);
    if (job.stopRequested())
        return piece;
    piece.primitives = readOutSurface(surface, *from.submesh, from.complex);
    return piece;
}

CloudPiece simplifyPiece(const CloudSubmesh& from,
                         const CloudMethod& method,
                         const CloudSettings& settings,
                         const JobContext& job) {
    return finishPiece(from, draftPiece(from, method, settings, job), job);
}

} // namespace lodestone
