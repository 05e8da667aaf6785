#include "simplify/measure/surface.h"

#include <cassert>
#include <cmath>

namespace lodestone {

Result<SurfaceFrame> frameOf(const Scene& scene) {
    const Bounds bounds = robustWorldBounds(scene);
    const double diagonal = bounds.diagonal();
    if (!(diagonal > 0.0) || !std::isfinite(diagonal))
        return badInput(scene.name + ": the scene has no extent, so distances have no unit; "
                                     "choose a scene with triangles");
    return SurfaceFrame{bounds.center(), 1.0 / diagonal};
}

glm::dvec3 SurfacePiece::corner(std::uint32_t vertex) const {
    return {to_frame * glm::dvec4(glm::dvec3(geometry->positions[vertex]), 1.0)};
}

Triangle SurfacePiece::triangle(std::size_t index) const {
    const std::uint32_t* corners = geometry->indices.data() + 3 * index;
    return {corner(corners[0]), corner(corners[1]), corner(corners[2])};
}

std::vector<SurfacePiece> surfacePieces(const LodView& view, const SurfaceFrame& frame) {
    const Scene& scene = *view.scene;
    assert(view.lod->submeshes.size() == scene.submeshes.size());
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    std::vector<SurfacePiece> pieces;
    for (std::uint32_t s = 0; s < scene.submeshes.size(); ++s) {
        const LodSubmesh& submesh = view.lod->submeshes[s];
        for (std::uint32_t kept = 0; kept < submesh.kept_instances; ++kept) {
            const std::uint32_t instance =
                submesh.instance_order ? (*submesh.instance_order)[kept] : ranges[s].begin + kept;
            glm::dmat4 to_frame = scene.instances[instance].transform;
            to_frame[3] -= glm::dvec4(frame.origin, 0.0);
            for (int column = 0; column < 4; ++column)
                to_frame[column] =
                    glm::dvec4(glm::dvec3(to_frame[column]) * frame.scale, to_frame[column].w);
            for (std::uint32_t p = 0; p < submesh.primitives.size(); ++p) {
                const GeometryPtr& geometry = submesh.primitives[p];
                const Primitive& primitive = scene.submeshes[s].primitives[p];
                if (geometry && geometry->triangleCount() > 0 &&
                    primitive.mode == PrimitiveMode::Triangles)
                    pieces.push_back({geometry.get(), to_frame, s, p, primitive.material});
            }
        }
    }
    return pieces;
}

bool isFar(const glm::dvec3& point) {
    // Negated so that a NaN counts as far.
    return !(std::abs(point.x) <= kFarLimit && std::abs(point.y) <= kFarLimit &&
             std::abs(point.z) <= kFarLimit);
}

bool isFar(const Triangle& triangle) {
    return isFar(triangle[0]) || isFar(triangle[1]) || isFar(triangle[2]);
}

double areaOf(const Triangle& triangle) {
    if (isFar(triangle))
        return 0.0;
    return 0.5 * glm::length(glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]));
}

} // namespace lodestone
