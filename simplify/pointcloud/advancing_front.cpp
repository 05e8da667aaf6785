#include "simplify/pointcloud/advancing_front.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <algorithm>
#include <exception>
#include <numeric>
#include <utility>

namespace lodestone {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Facet = std::array<std::size_t, 3>;

// The vertices that faces stand on, and what they know of the old surface.
struct Cloud {
    std::vector<std::uint32_t> vertices; // [points]
    std::vector<Kernel::Point_3> points; // [points]
    std::vector<glm::dvec3> normals;     // [points] sum over the old faces
    // [points] primitive and wedge, one each, rising
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> wedges;
};

Cloud makeCloud(const CloudSurface& surface) {
    Cloud cloud;
    std::vector<std::uint32_t> point_of(surface.positions.size(), kNone);
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        const glm::dvec3 normal = faceVector(surface.points(f));
        for (const std::uint32_t wedge : surface.faces[f]) {
            const std::uint32_t vertex = surface.wedge_vertex[wedge];
            if (point_of[vertex] == kNone) {
                point_of[vertex] = static_cast<std::uint32_t>(cloud.vertices.size());
                const glm::dvec3& at = surface.positions[vertex];
                cloud.vertices.push_back(vertex);
                cloud.points.emplace_back(at.x, at.y, at.z);
                cloud.normals.emplace_back(0.0);
                cloud.wedges.emplace_back();
            }
            const std::uint32_t point = point_of[vertex];
            cloud.normals[point] += normal;
            auto& wedges = cloud.wedges[point];
            const auto same = [&](const auto& known) {
                return known.first == surface.primitive[f];
            };
            if (std::ranges::none_of(wedges, same))
                wedges.emplace_back(surface.primitive[f], wedge);
        }
    }
    for (auto& wedges : cloud.wedges)
        std::ranges::sort(wedges);
    return cloud;
}

// Facets of one piece are turned alike: all of it is turned over where most would be.
void turnLikeBefore(const CloudSurface& surface, const Cloud& cloud, std::vector<Facet>& facets) {
    std::vector<std::size_t> parent(cloud.points.size());
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t p) {
        while (parent[p] != p)
            p = parent[p] = parent[parent[p]];
        return p;
    };
    for (const Facet& facet : facets)
        for (const std::size_t point : facet)
            parent[root(point)] = root(facet[0]);
    std::vector<double> agreement(cloud.points.size(), 0.0); // [roots]
    for (const Facet& facet : facets) {
        const Triangle3d points{surface.positions[cloud.vertices[facet[0]]],
                                surface.positions[cloud.vertices[facet[1]]],
                                surface.positions[cloud.vertices[facet[2]]]};
        const glm::dvec3 before =
            cloud.normals[facet[0]] + cloud.normals[facet[1]] + cloud.normals[facet[2]];
        agreement[root(facet[0])] += glm::dot(faceVector(points), before);
    }
    for (Facet& facet : facets)
        if (agreement[root(facet[0])] < 0.0)
            std::swap(facet[1], facet[2]);
}

// A wedge for each corner in the first primitive that all three have. False if there is none.
bool findWedges(const Cloud& cloud,
                const Facet& facet,
                Triangle& wedges,
                std::uint32_t& primitive) {
    for (const auto& candidate : cloud.wedges[facet[0]]) {
        std::size_t found = 0;
        for (const std::size_t point : facet)
            for (const auto& known : cloud.wedges[point])
                if (known.first == candidate.first && found < 3)
                    wedges[found++] = known.second;
        primitive = candidate.first;
        if (found == 3)
            return true;
    }
    return false;
}

} // namespace

bool canRebuildFromPoints() {
    return true;
}

void rebuildFromPoints(CloudSurface& surface) {
    constexpr std::size_t kFewest = 4; // points that span a volume
    const Cloud cloud = makeCloud(surface);
    std::vector<Facet> facets;
    if (cloud.points.size() < kFewest)
        return;
    try {
        CGAL::advancing_front_surface_reconstruction(
            cloud.points.begin(), cloud.points.end(), std::back_inserter(facets));
    } catch (const std::exception&) {
        return; // points that it cannot triangulate: the old faces stay
    }
    turnLikeBefore(surface, cloud, facets);
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> primitives;
    for (const Facet& facet : facets) {
        Triangle wedges{};
        std::uint32_t primitive = 0;
        if (!findWedges(cloud, facet, wedges, primitive))
            continue;
        faces.push_back(wedges);
        primitives.push_back(primitive);
    }
    if (faces.empty() || faces.size() > surface.faces.size())
        return;
    surface.faces = std::move(faces);
    surface.primitive = std::move(primitives);
    surface.two_sided.assign(surface.faces.size(), 0);
    surface.changed.assign(surface.faces.size(), 1);
    surface.from_points = true;
    forgetUnusedWedges(surface);
}

} // namespace lodestone
