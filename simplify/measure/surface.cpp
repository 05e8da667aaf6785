#include "simplify/measure/surface.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

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

namespace {

// Parameter, 0..1 from a to b, of the segment's point that is closest.
double closestParameter(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 along = b - a;
    const double length2 = glm::dot(along, along);
    return length2 > 0.0 ? std::clamp(glm::dot(point - a, along) / length2, 0.0, 1.0) : 0.0;
}

double squaredDistanceToSegment(const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 to_point = point - (a + (b - a) * closestParameter(point, a, b));
    return glm::dot(to_point, to_point);
}

// Foot point on a triangle's plane: barycentric weights of b and c times the squared double area.
struct Foot {
    double v = 0.0;
    double w = 0.0;
    double area2 = 0.0;
    bool inside = false; // of a triangle that has an area
};

Foot footOf(const glm::dvec3& point, const Triangle& triangle) {
    const glm::dvec3 ab = triangle[1] - triangle[0];
    const glm::dvec3 ac = triangle[2] - triangle[0];
    const glm::dvec3 ap = point - triangle[0];
    const double ab_ab = glm::dot(ab, ab);
    const double ab_ac = glm::dot(ab, ac);
    const double ac_ac = glm::dot(ac, ac);
    const double ap_ab = glm::dot(ap, ab);
    const double ap_ac = glm::dot(ap, ac);
    Foot foot;
    foot.area2 = ab_ab * ac_ac - ab_ac * ab_ac;
    foot.v = ac_ac * ap_ab - ab_ac * ap_ac;
    foot.w = ab_ab * ap_ac - ab_ac * ap_ab;
    foot.inside = foot.v >= 0.0 && foot.w >= 0.0 && foot.v + foot.w <= foot.area2 &&
                  foot.area2 > 1e-14 * ab_ab * ac_ac;
    return foot;
}

} // namespace

double squaredDistance(const glm::dvec3& point, const Triangle& triangle) {
    const auto& [a, b, c] = triangle;
    if (footOf(point, triangle).inside) {
        const glm::dvec3 normal = glm::cross(b - a, c - a);
        const double height = glm::dot(normal, point - a);
        return height * height / glm::dot(normal, normal);
    }
    return std::min({squaredDistanceToSegment(point, a, b),
                     squaredDistanceToSegment(point, b, c),
                     squaredDistanceToSegment(point, c, a)});
}

glm::dvec3 closestWeights(const glm::dvec3& point, const Triangle& triangle) {
    const Foot foot = footOf(point, triangle);
    if (foot.inside)
        return {1.0 - (foot.v + foot.w) / foot.area2, foot.v / foot.area2, foot.w / foot.area2};
    glm::dvec3 weights(0.0);
    double best2 = std::numeric_limits<double>::infinity();
    for (int side = 0; side < 3; ++side) {
        const int next = (side + 1) % 3;
        const glm::dvec3& a = triangle[static_cast<std::size_t>(side)];
        const glm::dvec3& b = triangle[static_cast<std::size_t>(next)];
        const double t = closestParameter(point, a, b);
        const glm::dvec3 to_point = point - (a + (b - a) * t);
        if (const double distance2 = glm::dot(to_point, to_point); distance2 < best2) {
            best2 = distance2;
            weights = glm::dvec3(0.0);
            weights[side] = 1.0 - t;
            weights[next] = t;
        }
    }
    return weights;
}

glm::dvec3 closestPoint(const glm::dvec3& point, const Triangle& triangle) {
    const glm::dvec3 weights = closestWeights(point, triangle);
    return triangle[0] * weights.x + triangle[1] * weights.y + triangle[2] * weights.z;
}

} // namespace lodestone
