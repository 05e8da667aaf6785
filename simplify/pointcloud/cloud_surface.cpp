#include "simplify/pointcloud/cloud_surface.h"

#include "simplify/pointcloud/triangle_table.h"

#include <numeric>

namespace lodestone {

namespace {

// Marks the faces whose mirror image (same vertices, other orientation) is in the input, too.
void markTwoSided(CloudSurface& surface) {
    TriangleTable table(surface.faces.size());
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
        const TriangleKey key = triangleKey(surface.corners(f), 0);
        TriangleTable::Entry& entry = table.at(key);
        std::uint32_t& first = key.turned ? entry.backward : entry.forward;
        if (first == kNone)
            first = f;
    }
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
        const TriangleTable::Entry& entry = table.at(triangleKey(surface.corners(f), 0));
        surface.two_sided[f] = entry.forward != kNone && entry.backward != kNone;
    }
}

} // namespace

CloudSurface makeSurface(const Complex& complex) {
    CloudSurface surface;
    surface.positions.assign(complex.positions.begin(), complex.positions.end());
    surface.wedge_vertex = complex.wedge_vertex;
    surface.stands_for.resize(surface.positions.size());
    std::iota(surface.stands_for.begin(), surface.stands_for.end(), 0u);
    surface.faces = complex.faces;
    surface.primitive.resize(surface.faces.size());
    for (std::uint32_t p = 0; p + 1 < complex.face_begin.size(); ++p)
        std::fill(surface.primitive.begin() + complex.face_begin[p],
                  surface.primitive.begin() + complex.face_begin[p + 1],
                  p);
    surface.two_sided.resize(surface.faces.size());
    surface.changed.resize(surface.faces.size());
    markTwoSided(surface);
    return surface;
}

glm::dvec3 faceVector(const Triangle3d& points) {
    return glm::cross(points[1] - points[0], points[2] - points[0]);
}

Stars buildStars(const CloudSurface& surface) {
    Stars stars;
    stars.begin.assign(surface.positions.size() + 1, 0);
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const std::uint32_t vertex : surface.corners(f))
            ++stars.begin[vertex + 1];
    std::partial_sum(stars.begin.begin(), stars.begin.end(), stars.begin.begin());
    stars.faces.resize(3 * surface.faces.size());
    std::vector<std::uint32_t> at(stars.begin.begin(), stars.begin.end() - 1);
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f)
        for (const std::uint32_t vertex : surface.corners(f))
            stars.faces[at[vertex]++] = f;
    return stars;
}

} // namespace lodestone
