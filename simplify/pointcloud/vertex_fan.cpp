#include "simplify/pointcloud/vertex_fan.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::size_t kMostFaces = 64;

// Puts the blades in order, starting at an open end if there is one. False: not one fan.
bool orderBlades(std::vector<Blade>& blades, bool& closed) {
    std::size_t starts = 0;
    for (std::size_t i = 0; i < blades.size(); ++i) {
        const auto before = std::ranges::count(blades, blades[i].from, &Blade::to);
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
        const auto rest = blades.begin() + static_cast<std::ptrdiff_t>(i);
        const auto next = std::ranges::find(rest, blades.end(), blades[i - 1].to, &Blade::from);
        if (next == blades.end())
            return false;
        std::iter_swap(rest, next);
    }
    closed = starts == 0;
    return !closed || blades.back().to == blades.front().from;
}

void findSeams(const CloudSurface& surface, VertexFan& fan) {
    if (!fan.closed)
        fan.seams.push_back(0);
    const std::size_t count = fan.faces.size();
    const auto centre_wedge = [&](const Blade& blade) {
        return surface.faces[blade.face][blade.which];
    };
    for (std::size_t i = fan.closed ? 0 : 1; i < count; ++i) {
        const Blade& before = fan.blades[i == 0 ? count - 1 : i - 1];
        const Blade& after = fan.blades[i];
        const Spoke& spoke = fan.spokes[i];
        const auto differ = [&](std::uint32_t a, std::uint32_t b) {
            return surface.chart[a] != surface.chart[b];
        };
        if (surface.primitive[before.face] != surface.primitive[after.face] ||
            differ(centre_wedge(before), centre_wedge(after)) ||
            differ(spoke.wedge_before, spoke.wedge_after))
            fan.seams.push_back(static_cast<std::uint32_t>(i));
    }
    if (!fan.closed)
        fan.seams.push_back(static_cast<std::uint32_t>(count));
}

} // namespace

bool makeFan(const CloudSurface& surface,
             std::span<const Triangle> corners,
             std::span<const std::uint32_t> star,
             VertexFan& fan) {
    fan.faces.clear();
    fan.spokes.clear();
    fan.seams.clear();
    fan.blades.clear();
    if (star.empty() || star.size() > kMostFaces)
        return false;
    for (const std::uint32_t corner : star) {
        const std::uint32_t face = corner / 3;
        const std::uint32_t which = corner % 3;
        fan.blades.push_back(
            {face, which, corners[face][(which + 1) % 3], corners[face][(which + 2) % 3]});
    }
    if (!orderBlades(fan.blades, fan.closed))
        return false;
    const auto wedge_from = [&](const Blade& b) {
        return surface.faces[b.face][(b.which + 1) % 3];
    };
    const auto wedge_to = [&](const Blade& b) { return surface.faces[b.face][(b.which + 2) % 3]; };
    std::uint32_t before = fan.closed ? wedge_to(fan.blades.back()) : kNone;
    for (const Blade& blade : fan.blades) {
        fan.faces.push_back(blade.face);
        fan.spokes.push_back({blade.from, before, wedge_from(blade)});
        before = wedge_to(blade);
    }
    if (!fan.closed)
        fan.spokes.push_back({fan.blades.back().to, before, kNone});
    findSeams(surface, fan);
    return true;
}

} // namespace lodestone
