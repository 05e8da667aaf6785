#include "simplify/measure/surface.h"

#include <algorithm>
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
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s) {
        const LodSubmesh& submesh = view.lod->submeshes[s];
        for (std::uint32_t kept = 0; kept < submesh.kept_instances; ++kept) {
            const std::uint32_t instance =
                submesh.instance_order ? (*submesh.instance_order)[kept] : ranges[s].begin + kept;
            glm::dmat4 to_frame = scene.instances[instance].transform;
            to_frame[3] -= glm::dvec4(frame.origin, 0.0);
            for (int column = 0; column < 4; ++column)
                to_frame[column] =
                    glm::dvec4(glm::dvec3(to_frame[column]) * frame.scale, to_frame[column].w);
            for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
                const GeometryPtr& geometry = submesh.primitives[p];
                if (geometry && geometry->triangleCount() > 0 &&
                    scene.submeshes[s].primitives[p].mode == PrimitiveMode::Triangles)
                    pieces.push_back({geometry.get(), to_frame});
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

namespace {

double squaredDistanceToSegment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double length2 = glm::dot(along, along);
    const double t =
        length2 > 0.0 ? std::clamp(glm::dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
    const glm::dvec3 to_point = point - (a + along * t);
    return glm::dot(to_point, to_point);
}

} // namespace

double squaredDistance(const glm::dvec3& point, const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    const glm::dvec3 ab = b - a;
    const glm::dvec3 ac = c - a;
    const glm::dvec3 ap = point - a;
    const double ab_ab = glm::dot(ab, ab);
    const double ab_ac = glm::dot(ab, ac);
    const double ac_ac = glm::dot(ac, ac);
    const double ap_ab = glm::dot(ap, ab);
    const double ap_ac = glm::dot(ap, ac);
    // Barycentric coordinates of the foot point, times the squared double area.
    const double area2 = ab_ab * ac_ac - ab_ac * ab_ac;
    const double v = ac_ac * ap_ab - ab_ac * ap_ac;
    const double w = ab_ab * ap_ac - ab_ac * ap_ab;
    if (v >= 0.0 && w >= 0.0 && v + w <= area2 && area2 > 1e-14 * ab_ab * ac_ac) {
        const glm::dvec3 normal = glm::cross(ab, ac);
        const double height = glm::dot(normal, ap);
        return height * height / glm::dot(normal, normal);
    }
    return std::min({squaredDistanceToSegment(point, a, b),
                     squaredDistanceToSegment(point, b, c),
                     squaredDistanceToSegment(point, c, a)});
}

} // namespace lodestone
