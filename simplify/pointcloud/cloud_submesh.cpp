#include "simplify/pointcloud/cloud_submesh.h"

#include "simplify/pointcloud/advancing_front.h"
#include "simplify/pointcloud/cloud_read_out.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

// The largest factor by which a linear map stretches a length: the root of the largest eigenvalue
// of its Gram matrix, by power iteration.
double stretchOf(const glm::dmat3& linear) {
    const glm::dmat3 gram = glm::transpose(linear) * linear;
    glm::dvec3 v(1.0, 0.7, 0.4);
    double length = 0.0;
    for (int i = 0; i < 32; ++i) {
        v = gram * v;
        length = glm::length(v);
        if (!(length > 0.0))
            return 0.0;
        v /= length;
    }
    return std::sqrt(length);
}

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
        made.stretch = std::max(made.stretch, stretchOf(glm::dmat3(instances[i].transform)));
    }
    if (made.stretch <= 0.0)
        return made;
    made.complex = buildComplex(submesh, job);
    if (!job.stopRequested())
        made.surface = makeSurface(submesh, made.complex);
    return made;
}

CloudPiece originalPiece(const CloudSubmesh& from) {
    CloudPiece piece;
    for (const Primitive& primitive : from.submesh->primitives)
        piece.primitives.push_back(primitive.geometry);
    piece.triangles = from.triangles;
    return piece;
}

CloudPiece simplifyPiece(const CloudSubmesh& from,
                         const CloudMethod& method,
                         const CloudSettings& settings,
                         const JobContext& job) {
    CloudSurface surface = from.surface;
    method.run(surface, from.complex, settings, job);
    const auto is_changed = [](std::uint8_t flag) { return flag != 0; };
    if (job.stopRequested() || (surface.faces.size() == from.surface.faces.size() &&
                                std::ranges::none_of(surface.changed, is_changed)))
        return originalPiece(from);
    if (settings.retriangulation == Retriangulation::PointCloud)
        rebuildFromPoints(surface);
    CloudPiece piece;
    piece.primitives = readOutSurface(surface, *from.submesh, from.complex);
    piece.triangles = static_cast<std::uint32_t>(surface.faces.size());
    piece.error = farthestMove(surface, from.complex);
    piece.changed = true;
    return piece;
}

} // namespace lodestone
