#include "simplify/pointcloud/retriangulate.h"

#include "simplify/pointcloud/triangle_table.h"

#include <limits>
#include <numeric>

namespace lodestone {

namespace {

std::uint32_t findRoot(std::vector<std::uint32_t>& parent, std::uint32_t v) {
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

// Wedges that become one: those that a face joins whose corners merge. Across a seam no face does.
// Result [wedges]: the wedge that stands for it.
std::vector<std::uint32_t> groupWedges(const CloudSurface& surface,
                                       const Merges& merges,
                                       const Complex& complex,
                                       const JobContext& job) {
    std::vector<std::uint32_t> parent(surface.wedge_vertex.size());
    std::iota(parent.begin(), parent.end(), 0u);
    bool any = false;
    for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const Triangle corners = surface.corners(f);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            if (merges.target[corners[k]] != merges.target[corners[next]])
                continue;
            const std::uint32_t a = findRoot(parent, surface.faces[f][k]);
            const std::uint32_t b = findRoot(parent, surface.faces[f][next]);
            parent[std::max(a, b)] = std::min(a, b);
            any = true;
        }
    }
    if (!any)
        return parent;
    if (job.stopRequested())
        return parent;
    std::vector<std::uint32_t> nearest(parent.size(), kNone); // [roots]
    std::vector<double> distance2(parent.size(), std::numeric_limits<double>::max());
    for (std::uint32_t w = 0; w < parent.size() && !stopsAt(w, job); ++w) {
        if (surface.wedge_vertex[w] == kNone)
            continue;
        const std::uint32_t root = findRoot(parent, w);
        const glm::dvec3 place = merges.positions[merges.target[surface.wedge_vertex[w]]];
        const glm::dvec3 away = glm::dvec3(complex.positions[complex.wedge_vertex[w]]) - place;
        if (glm::dot(away, away) < distance2[root]) {
            distance2[root] = glm::dot(away, away);
            nearest[root] = w;
        }
    }
    std::vector<std::uint32_t> stands_for(parent.size());
    for (std::uint32_t w = 0; w < parent.size() && !stopsAt(w, job); ++w) {
        const std::uint32_t chosen = nearest[findRoot(parent, w)];
        stands_for[w] = chosen == kNone ? w : chosen;
    }
    return stands_for;
}

// Gives each face its new corners; drops those that have collapsed and notes which have changed.
// Result [faces that are left]: it still faces the side that it faced. Left halfway where asked to
// stop.
std::vector<std::uint8_t> remapFaces(CloudSurface& surface,
                                     const Merges& merges,
                                     std::span<const std::uint32_t> wedge_for,
                                     const JobContext& job) {
    std::vector<bool> moved(merges.target.size());
    for (std::uint32_t v = 0; v < merges.target.size(); ++v)
        if (merges.target[v] != v || merges.positions[v] != surface.positions[v]) {
            moved[v] = true;
            moved[merges.target[v]] = true;
        }
    std::vector<std::uint8_t> upright(surface.faces.size(), 1);
    std::size_t kept = 0;
    for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const Triangle old = surface.corners(f);
        const std::uint32_t a = merges.target[old[0]];
        const std::uint32_t b = merges.target[old[1]];
        const std::uint32_t c = merges.target[old[2]];
        if (a == b || b == c || a == c)
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            surface.faces[kept][k] = wedge_for[surface.faces[f][k]];
        surface.primitive[kept] = surface.primitive[f];
        surface.two_sided[kept] = surface.two_sided[f];
        surface.changed[kept] = surface.changed[f] || moved[a] || moved[b] || moved[c];
        if (surface.changed[kept]) {
            const glm::dvec3 before = faceVector(
                {surface.positions[old[0]], surface.positions[old[1]], surface.positions[old[2]]});
            const glm::dvec3 after =
                faceVector({merges.positions[a], merges.positions[b], merges.positions[c]});
            upright[kept] = glm::dot(before, after) > 0.0;
        }
        ++kept;
    }
    surface.faces.resize(kept);
    surface.primitive.resize(kept);
    surface.two_sided.resize(kept);
    surface.changed.resize(kept);
    upright.resize(kept);
    return upright;
}

// Where both faces of an opposite pair face as they did, the two sides of something thin have met:
// without them it would be gone. Else one of them is folded over onto the other, and they cancel.
void dropDoubles(CloudSurface& surface,
                 std::span<const std::uint8_t> upright,
                 const JobContext& job) {
    const auto changed = static_cast<std::size_t>(
        std::ranges::count_if(surface.changed, [](std::uint8_t flag) { return flag != 0; }));
    TriangleTable table(changed, job);
    for (std::uint32_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        if (!surface.changed[f])
            continue;
        const TriangleKey key = triangleKey(surface.corners(f), surface.primitive[f]);
        TriangleTable::Entry& entry = table.at(key);
        std::uint32_t& first = key.turned ? entry.backward : entry.forward;
        first = std::min(first, f);
        if (surface.two_sided[f])
            (key.turned ? entry.backward_pinned : entry.forward_pinned) = true;
        else
            ++(key.turned ? entry.backward_count : entry.forward_count);
        if (upright[f])
            (key.turned ? entry.backward_upright : entry.forward_upright) = true;
    }
    std::vector<bool> keep(surface.faces.size(), true);
    for (std::uint32_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        if (!surface.changed[f])
            continue;
        const TriangleKey key = triangleKey(surface.corners(f), surface.primitive[f]);
        const TriangleTable::Entry& entry = table.at(key);
        const std::uint32_t own = key.turned ? entry.backward_count : entry.forward_count;
        const std::uint32_t others = key.turned ? entry.forward_count : entry.backward_count;
        const bool pinned = key.turned ? entry.backward_pinned : entry.forward_pinned;
        const bool is_sheet = entry.forward_upright && entry.backward_upright;
        const bool survives = own > others || pinned || is_sheet;
        keep[f] = survives && f == (key.turned ? entry.backward : entry.forward);
    }
    keepFaces(surface, [&](std::size_t f) { return keep[f]; });
}

} // namespace

void applyMerges(CloudSurface& surface,
                 const Merges& merges,
                 const Complex& complex,
                 const JobContext& job) {
    if (job.stopRequested())
        return; // the merges may not be whole either
    const std::vector<std::uint32_t> wedge_for = groupWedges(surface, merges, complex, job);
    if (job.stopRequested())
        return;
    const std::vector<std::uint8_t> upright = remapFaces(surface, merges, wedge_for, job);
    for (std::uint32_t& vertex : surface.wedge_vertex)
        if (vertex != kNone)
            vertex = merges.target[vertex];
    for (std::uint32_t& vertex : surface.stands_for)
        if (vertex != kNone)
            vertex = merges.target[vertex];
    surface.positions = merges.positions;
    if (job.stopRequested())
        return;
    dropDoubles(surface, upright, job);
    forgetUnusedWedges(surface);
}

} // namespace lodestone
