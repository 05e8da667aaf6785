#include "simplify/pointcloud/cloud_surface.h"

#include "simplify/pointcloud/triangle_table.h"

#include <cstring>
#include <numeric>

namespace lodestone {

namespace {

// Marks the faces whose mirror image (same vertices, other orientation) is in the input, too.
void markTwoSided(CloudSurface& surface, const JobContext& job) {
    TriangleTable table(surface.faces.size(), job);
    for (std::uint32_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const TriangleKey key = triangleKey(surface.corners(f), 0);
        TriangleTable::Entry& entry = table.at(key);
        std::uint32_t& first = key.turned ? entry.backward : entry.forward;
        if (first == kNone)
            first = f;
    }
    for (std::uint32_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const TriangleTable::Entry& entry = table.at(triangleKey(surface.corners(f), 0));
        surface.two_sided[f] = entry.forward != kNone && entry.backward != kNone;
    }
}

bool isShading(const Attribute& attribute) {
    return attribute.semantic == "NORMAL" || attribute.semantic == "TANGENT";
}

bool sameChart(const Geometry& geometry, std::uint32_t a, std::uint32_t b) {
    return std::ranges::all_of(geometry.attributes, [&](const Attribute& attribute) {
        const std::size_t stride = attribute.stride();
        return isShading(attribute) || std::memcmp(attribute.bytes.data() + a * stride,
                                                   attribute.bytes.data() + b * stride,
                                                   stride) == 0;
    });
}

// Wedges of a vertex and primitive that look alike get the number of the first of them.
std::vector<std::uint32_t>
findCharts(const Submesh& submesh, const Complex& complex, const JobContext& job) {
    std::vector<std::uint32_t> chart(complex.wedge_vertex.size());
    std::vector<std::uint32_t> first(complex.positions.size(), kNone); // [vertices] chart
    std::vector<std::uint32_t> next(chart.size(), kNone);              // [charts] of the vertex
    for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
        const Geometry& geometry = *submesh.primitives[p].geometry;
        const std::uint32_t begin = complex.wedge_begin[p];
        for (std::uint32_t w = begin; w < complex.wedge_begin[p + 1] && !stopsAt(w, job); ++w) {
            std::uint32_t at = first[complex.wedge_vertex[w]];
            while (at != kNone && at >= begin &&
                   !sameChart(geometry, complex.wedge_source[at], complex.wedge_source[w]))
                at = next[at];
            chart[w] = at != kNone && at >= begin ? at : w;
            if (chart[w] != w)
                continue;
            next[w] = first[complex.wedge_vertex[w]];
            first[complex.wedge_vertex[w]] = w;
        }
    }
    return chart;
}

} // namespace

CloudSurface makeSurface(const Submesh& submesh, const Complex& complex, const JobContext& job) {
    CloudSurface surface;
    if (job.stopRequested())
        return surface;
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
    surface.chart = findCharts(submesh, complex, job);
    markTwoSided(surface, job);
    return job.stopRequested() ? CloudSurface() : surface;
}

void forgetUnusedWedges(CloudSurface& surface) {
    std::vector<bool> used(surface.wedge_vertex.size(), false);
    for (const Triangle& face : surface.faces)
        for (const std::uint32_t wedge : face)
            used[wedge] = true;
    for (std::size_t w = 0; w < used.size(); ++w)
        if (!used[w])
            surface.wedge_vertex[w] = kNone;
}

glm::dvec3 faceVector(const Triangle3d& points) {
    return glm::cross(points[1] - points[0], points[2] - points[0]);
}

Stars buildStars(std::span<const Triangle> faces, std::size_t vertex_count, const JobContext& job) {
    Stars stars;
    stars.begin.assign(vertex_count + 1, 0);
    for (std::size_t f = 0; f < faces.size() && !stopsAt(f, job); ++f)
        for (const std::uint32_t vertex : faces[f])
            ++stars.begin[vertex + 1];
    if (job.stopRequested())
        return {};
    std::partial_sum(stars.begin.begin(), stars.begin.end(), stars.begin.begin());
    stars.corners.resize(3 * faces.size());
    std::vector<std::uint32_t> at(stars.begin.begin(), stars.begin.end() - 1);
    for (std::uint32_t corner = 0; corner < stars.corners.size() && !stopsAt(corner, job); ++corner)
        stars.corners[at[faces[corner / 3][corner % 3]]++] = corner;
    return stars;
}

} // namespace lodestone
