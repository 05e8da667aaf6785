#include "simplify/pointcloud/vertex_fan.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::size_t kMostFaces = 64;

// A face seen from the vertex: vertex, then `from`, then `to`.
struct Blade {
    std::uint32_t face = 0;
    std::uint32_t from = 0; // wedges
    std::uint32_t to = 0;
};

Blade bladeOf(const CloudSurface& surface, std::uint32_t vertex, std::uint32_t face) {
    const Triangle& wedges = surface.faces[face];
    std::size_t k = 0;
    while (surface.wedge_vertex[wedges[k]] != vertex)
        ++k;
    return {face, wedges[(k + 1) % 3], wedges[(k + 2) % 3]};
}

std::uint32_t centreWedge(const CloudSurface& surface, std::uint32_t vertex, std::uint32_t face) {
    for (const std::uint32_t wedge : surface.faces[face])
        if (surface.wedge_vertex[wedge] == vertex)
            return wedge;
    return kNone;
}

// Puts the blades in order, starting at an open end if there is one. False: not one fan.
bool orderBlades(const CloudSurface& surface, std::vector<Blade>& blades, bool& closed) {
    const auto from = [&](const Blade& blade) { return surface.wedge_vertex[blade.from]; };
    const auto to = [&](const Blade& blade) { return surface.wedge_vertex[blade.to]; };
    std::size_t starts = 0;
    for (std::size_t i = 0; i < blades.size(); ++i) {
        const auto follows = [&](const Blade& b) { return to(b) == from(blades[i]); };
        const auto before = std::ranges::count_if(blades, follows);
        if (before > 1)
            return false;
        if (before == 0) {
            ++starts;
            std::swap(blades[0], blades[i]);
        }
    }
    if (starts > 1)
        return false;
    for (std::size_t i = 1; i < blades.size(); ++i) {
        const auto next =
            std::find_if(blades.begin() + static_cast<std::ptrdiff_t>(i),
                         blades.end(),
                         [&](const Blade& b) { return from(b) == to(blades[i - 1]); });
        if (next == blades.end())
            return false;
        std::iter_swap(blades.begin() + static_cast<std::ptrdiff_t>(i), next);
    }
    closed = starts == 0;
    return !closed || to(blades.back()) == from(blades.front());
}

void findSeams(const CloudSurface& surface, std::uint32_t vertex, VertexFan& fan) {
    if (!fan.closed)
        fan.seams.push_back(0);
    const std::size_t count = fan.faces.size();
    for (std::size_t i = fan.closed ? 0 : 1; i < count; ++i) {
        const std::uint32_t before = fan.faces[(i + count - 1) % count];
        const std::uint32_t after = fan.faces[i];
        const Spoke& spoke = fan.spokes[i];
        const auto differ = [&](std::uint32_t a, std::uint32_t b) {
            return surface.chart[a] != surface.chart[b];
        };
        if (surface.primitive[before] != surface.primitive[after] ||
            differ(centreWedge(surface, vertex, before), centreWedge(surface, vertex, after)) ||
            differ(spoke.wedge_before, spoke.wedge_after))
            fan.seams.push_back(static_cast<std::uint32_t>(i));
    }
    if (!fan.closed)
        fan.seams.push_back(static_cast<std::uint32_t>(count));
}

} // namespace

bool makeFan(const CloudSurface& surface,
             std::uint32_t vertex,
             std::span<const std::uint32_t> star,
             VertexFan& fan) {
    fan = {};
    if (star.empty() || star.size() > kMostFaces)
        return false;
    std::vector<Blade> blades;
    for (const std::uint32_t face : star)
        blades.push_back(bladeOf(surface, vertex, face));
    if (!orderBlades(surface, blades, fan.closed))
        return false;
    for (std::size_t i = 0; i < blades.size(); ++i) {
        fan.faces.push_back(blades[i].face);
        const bool open_start = i == 0 && !fan.closed;
        const Blade& before = blades[(i + blades.size() - 1) % blades.size()];
        fan.spokes.push_back(
            {surface.wedge_vertex[blades[i].from], open_start ? kNone : before.to, blades[i].from});
    }
    if (!fan.closed)
        fan.spokes.push_back({surface.wedge_vertex[blades.back().to], blades.back().to, kNone});
    findSeams(surface, vertex, fan);
    return true;
}

} // namespace lodestone
