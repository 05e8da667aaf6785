#include "scene/generate/maple_parts.h"

#include <algorithm>
#include <cmath>

namespace lodestone::generate {

namespace {

double segmentOf(const std::vector<PathPoint>& path, double t, std::size_t& index) {
    const double at = std::clamp(t, 0.0, 1.0) * static_cast<double>(path.size() - 1);
    index = std::min(static_cast<std::size_t>(at), path.size() - 2);
    return at - static_cast<double>(index);
}

// Bark: long furrows around the stem, finer grain on top; about -1..1.
double bark(const glm::dvec3& around, double along, std::uint32_t seed) {
    const double ridges = noise({around.x * 5.0, along * 1.4, around.z * 5.0}, seed);
    const double furrow = 1.0 - 2.0 * std::abs(ridges);
    const double grain = fractalNoise({around.x * 14.0, along * 5.0, around.z * 14.0}, seed + 9, 2);
    return 0.7 * furrow + 0.4 * grain;
}

} // namespace

glm::dvec3 Limb::at(double t) const {
    std::size_t i = 0;
    const double f = segmentOf(path, t, i);
    return path[i].position + (path[i + 1].position - path[i].position) * f;
}

double Limb::radiusAt(double t) const {
    std::size_t i = 0;
    const double f = segmentOf(path, t, i);
    return path[i].radius + (path[i + 1].radius - path[i].radius) * f;
}

Limb makeLimb(const LimbShape& shape, Random& random) {
    Limb limb;
    const double phase = random.in(0.0, 6.0);
    const auto seed = static_cast<std::uint32_t>(random.bits());
    for (int r = 0; r <= shape.rings; ++r) {
        const double t = static_cast<double>(r) / shape.rings;
        const double free = sine(kPi * t); // both ends stay where they are
        const double collar = 1.0 + 0.5 * (1.0 - smoothStep(0.0, 0.10, t));
        const double taper = shape.tip_radius + (shape.radius - shape.tip_radius) * (1.0 - t);
        limb.path.push_back(
            {{shape.wiggle * free * sine(7.0 * t + phase),
              t,
              -shape.bow * free + shape.wiggle * free * sine(9.0 * t + 2.0 * phase)},
             taper * collar});
    }
    addTube(limb.mesh, limb.path, shape.sides);
    for (std::size_t v = 0; v < limb.mesh.positions.size(); ++v) {
        const PathPoint& ring = limb.path[v / static_cast<std::size_t>(shape.sides)];
        glm::dvec3& p = limb.mesh.positions[v];
        const glm::dvec3 out = (p - ring.position) / ring.radius;
        p += out *
             (ring.radius * shape.relief * bark(out, ring.position.y / shape.radius * 0.25, seed));
    }
    return limb;
}

Twig makeTwig(int shoot_pairs, Random& random) {
    Twig twig;
    const Limb stem = makeLimb({0.016, 0.006, 0.07, 0.03, 0.0, 5, 7}, random);
    twig.mesh = stem.mesh;
    for (int pair = 0; pair < shoot_pairs; ++pair) {
        const double t = 0.34 + 0.5 * pair / std::max(1, shoot_pairs - 1);
        const double turn = pair % 2 == 0 ? 0.4 : 1.9;
        for (const double side : {0.0, kPi}) {
            const double length = random.in(0.24, 0.36) * (1.15 - 0.5 * t);
            const double around = turn + side + random.about(0.0, 0.25);
            const glm::dvec3 out(cosine(around), 0.0, sine(around));
            const glm::dvec3 from = stem.at(t);
            const glm::dvec3 heading = glm::normalize(out + glm::dvec3(0.0, 0.9, 0.0));
            const glm::dvec3 end = from + heading * length;
            const glm::dvec3 middle = (from + end) * 0.5 + out * (0.06 * length);
            const std::array<PathPoint, 3> shoot{
                {{from, stem.radiusAt(t) * 0.75}, {middle, 0.008}, {end, 0.005}}};
            addTube(twig.mesh, shoot, 4);
            twig.sockets.push_back({end, heading});
            twig.sockets.push_back({middle, glm::normalize(heading + out)});
        }
    }
    for (const double t : {0.5, 0.75, 0.93})
        for (const double side : {0.0, kPi}) {
            const double around = side + t * 9.0;
            twig.sockets.push_back({stem.at(t), {cosine(around), 0.5, sine(around)}});
        }
    twig.sockets.push_back({stem.at(1.0), {0.0, 1.0, 0.0}});
    return twig;
}

Limb makeTrunkLine(double height, Random& random) {
    Limb trunk;
    const double phase = random.in(0.0, 6.0);
    constexpr int kRings = 84;
    for (int r = 0; r <= kRings; ++r) {
        // Rings are denser where the roots spread.
        const double t = static_cast<double>(r) / kRings;
        const double y = height * t * (0.35 + 0.65 * t);
        const double free = smoothStep(0.05, 0.5, y / height);
        const glm::dvec3 p(
            0.16 * free * sine(0.9 * y + phase), y, 0.16 * free * sine(0.7 * y + 2.0 * phase));
        const double h = y / height;
        const double taper = 0.235 * (1.0 - h) * (1.0 - 0.25 * h) + 0.022;
        trunk.path.push_back({p, taper});
    }
    return trunk;
}

void skinTrunk(Limb& trunk, std::size_t triangle_count, std::uint32_t seed) {
    constexpr int kSides = 64;
    addTube(trunk.mesh, trunk.path, kSides);
    refineTo(trunk.mesh, triangle_count);
    for (glm::dvec3& p : trunk.mesh.positions) {
        const auto next = std::ranges::lower_bound(
            trunk.path, p.y, {}, [](const PathPoint& point) { return point.position.y; });
        const PathPoint& ring = next == trunk.path.end() ? trunk.path.back() : *next;
        glm::dvec3 out = p - ring.position;
        out.y = 0.0;
        const double distance = glm::length(out);
        if (distance < ring.radius * 0.3)
            continue; // inside a cap
        const glm::dvec3 dir = out / distance;
        const double fall = p.y / 0.34;
        const double flare = 1.0 / (1.0 + fall * fall);
        const double roots = 0.35 + noise({dir.x * 2.1, p.y * 0.3, dir.z * 2.1}, seed + 3);
        const double swell = 1.0 + flare * (0.40 + 0.80 * std::max(0.0, roots));
        const double depth = 0.04 + 0.05 * smoothStep(0.05, 0.2, ring.radius) * (1.0 - flare);
        p += dir * (distance * (swell - 1.0 + depth * bark(dir, p.y * 2.2, seed)));
    }
}

} // namespace lodestone::generate
