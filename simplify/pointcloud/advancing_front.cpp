#include "simplify/pointcloud/advancing_front.h"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <algorithm>
#include <exception>
#include <limits>
#include <numeric>
#include <set>
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

using DirectedEdges = std::vector<std::array<std::size_t, 2>>; // sorted

template <class Corners>
DirectedEdges directedEdges(std::size_t face_count, const Corners& corners) {
    DirectedEdges edges;
    edges.reserve(3 * face_count);
    for (std::size_t f = 0; f < face_count; ++f) {
        const auto face = corners(f);
        for (std::size_t k = 0; k < 3; ++k)
            edges.push_back({face[k], face[(k + 1) % 3]});
    }
    std::ranges::sort(edges);
    return edges;
}

bool hasEdge(const DirectedEdges& edges, std::size_t from, std::size_t to) {
    return std::ranges::binary_search(edges, std::array{from, to});
}

bool isClosed(const CloudSurface& surface) {
    const DirectedEdges edges =
        directedEdges(surface.faces.size(), [&](std::size_t f) { return surface.corners(f); });
    return std::ranges::all_of(edges,
                               [&](const auto& edge) { return hasEdge(edges, edge[1], edge[0]); });
}

// Which points the facets join, those included that fill holes.
class Joined {
public:
    explicit Joined(const DirectedEdges& edges) : edges_(edges) {}

    bool are(std::size_t a, std::size_t b) const {
        return hasEdge(edges_, a, b) || hasEdge(edges_, b, a) || cuts_.contains(std::minmax(a, b));
    }

    void join(std::size_t a, std::size_t b) { cuts_.insert(std::minmax(a, b)); }

private:
    const DirectedEdges& edges_;
    std::set<std::pair<std::size_t, std::size_t>> cuts_;
};

// Cuts ears off a loop, those with the shortest cut first. No cut joins points that are joined
// already, for then more than two facets would meet there; where every cut does, the shortest.
void fillLoop(const Cloud& cloud,
              std::vector<std::size_t> loop,
              Joined& joined,
              std::vector<Facet>& facets) {
    const auto at = [&](std::size_t i) { return loop[i % loop.size()]; };
    while (loop.size() >= 3) {
        std::size_t ear = 0;
        std::pair<bool, double> best{true, std::numeric_limits<double>::max()};
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const double cut = CGAL::squared_distance(cloud.points[at(i)], cloud.points[at(i + 2)]);
            const bool again = loop.size() > 3 && joined.are(at(i), at(i + 2));
            if (std::pair{again, cut} < best) {
                best = {again, cut};
                ear = i;
            }
        }
        facets.push_back({at(ear), at(ear + 1), at(ear + 2)});
        joined.join(at(ear), at(ear + 2));
        loop.erase(loop.begin() + static_cast<std::ptrdiff_t>((ear + 1) % loop.size()));
    }
}

// The front leaves gaps where points are far apart for how the surface bends.
void closeSmallHoles(const Cloud& cloud, std::vector<Facet>& facets) {
    constexpr std::size_t kLongest = 24; // edges around one
    const DirectedEdges edges =
        directedEdges(facets.size(), [&](std::size_t f) { return facets[f]; });
    Joined joined(edges);
    std::vector<std::size_t> next(cloud.points.size(), cloud.points.size()); // around holes
    std::vector<bool> crossed(cloud.points.size(), false); // by two holes: told apart by nothing
    for (const auto& [from, to] : edges)
        if (!hasEdge(edges, to, from)) {
            crossed[to] = crossed[to] || next[to] != cloud.points.size();
            next[to] = from;
        }
    for (std::size_t start = 0; start < next.size(); ++start) {
        std::vector<std::size_t> loop;
        std::size_t point = start;
        while (point != next.size() && !crossed[point] && loop.size() <= kLongest) {
            loop.push_back(point);
            point = std::exchange(next[point], next.size());
            if (point == start) {
                fillLoop(cloud, std::move(loop), joined, facets);
                break;
            }
        }
    }
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
    if (isClosed(surface))
        closeSmallHoles(cloud, facets);
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
