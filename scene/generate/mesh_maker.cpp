#include "scene/generate/mesh_maker.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lodestone::generate {

std::uint32_t Mesh::addVertex(const glm::dvec3& p) {
    positions.push_back(p);
    return static_cast<std::uint32_t>(positions.size() - 1);
}

void Mesh::addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    triangles.push_back({a, b, c});
}

void Mesh::addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    addTriangle(a, b, c);
    addTriangle(a, c, d);
}

void Mesh::addFan(std::span<const std::uint32_t> loop) {
    for (std::size_t i = 2; i < loop.size(); ++i)
        addTriangle(loop[0], loop[i - 1], loop[i]);
}

void Mesh::append(const Mesh& other, const glm::dmat4& transform) {
    const auto base = static_cast<std::uint32_t>(positions.size());
    for (const glm::dvec3& p : other.positions)
        positions.emplace_back(transform * glm::dvec4(p, 1.0));
    for (const std::array<std::uint32_t, 3>& t : other.triangles)
        triangles.push_back({t[0] + base, t[1] + base, t[2] + base});
}

glm::dmat4 moved(const glm::dvec3& offset) {
    glm::dmat4 m(1.0);
    m[3] = glm::dvec4(offset, 1.0);
    return m;
}

glm::dmat4 scaled(const glm::dvec3& factors) {
    glm::dmat4 m(1.0);
    for (int axis = 0; axis < 3; ++axis)
        m[axis][axis] = factors[axis];
    return m;
}

namespace {

// Turns axis `from` towards axis `to`.
glm::dmat4 rotated(int from, int to, double angle) {
    glm::dmat4 m(1.0);
    m[from][from] = m[to][to] = cosine(angle);
    m[from][to] = sine(angle);
    m[to][from] = -m[from][to];
    return m;
}

} // namespace

glm::dmat4 rotatedX(double angle) {
    return rotated(1, 2, angle);
}

glm::dmat4 rotatedY(double angle) {
    return rotated(2, 0, angle);
}

glm::dmat4 rotatedZ(double angle) {
    return rotated(0, 1, angle);
}

void addBox(Mesh& mesh, const glm::dvec3& min, const glm::dvec3& max) {
    const Ring low{
        {min.x, min.y, min.z}, {min.x, min.y, max.z}, {max.x, min.y, max.z}, {max.x, min.y, min.z}};
    Ring high = low;
    for (glm::dvec3& p : high)
        p.y = max.y;
    addLoft(mesh, std::array{low, high});
}

void addLoft(Mesh& mesh, std::span<const Ring> rings, Ends ends) {
    const auto size = static_cast<std::uint32_t>(rings[0].size());
    std::vector<std::uint32_t> last;
    for (std::size_t r = 0; r < rings.size(); ++r) {
        assert(rings[r].size() == size);
        std::vector<std::uint32_t> ids(size);
        for (std::uint32_t i = 0; i < size; ++i)
            ids[i] = mesh.addVertex(rings[r][i]);
        if (r == 0 && ends == Ends::Capped)
            mesh.addFan(std::vector<std::uint32_t>(ids.rbegin(), ids.rend()));
        for (std::uint32_t i = 0; r > 0 && i < size; ++i)
            mesh.addQuad(last[i], last[(i + 1) % size], ids[(i + 1) % size], ids[i]);
        last = std::move(ids);
    }
    if (ends == Ends::Capped)
        mesh.addFan(last);
}

void addTube(Mesh& mesh, std::span<const PathPoint> path, int sides, Ends ends) {
    std::vector<Ring> rings;
    glm::dvec3 side(0.0);
    for (std::size_t i = 0; i < path.size(); ++i) {
        const glm::dvec3 from = path[i == 0 ? 0 : i - 1].position;
        const glm::dvec3 to = path[std::min(i + 1, path.size() - 1)].position;
        const glm::dvec3 forward = glm::normalize(to - from);
        if (i == 0)
            side = std::abs(forward.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
        side = glm::normalize(side - forward * glm::dot(side, forward));
        const glm::dvec3 up = glm::cross(forward, side);
        Ring ring;
        for (int s = 0; s < sides; ++s) {
            const double a = 2.0 * kPi * s / sides;
            ring.push_back(path[i].position + (side * cosine(a) + up * sine(a)) * path[i].radius);
        }
        rings.push_back(std::move(ring));
    }
    addLoft(mesh, rings, ends);
}

void addTurned(Mesh& mesh, std::span<const glm::dvec2> profile, int sides) {
    std::vector<Ring> rings;
    for (const glm::dvec2& point : profile) {
        Ring ring;
        for (int s = 0; s < sides; ++s) {
            const double a = -2.0 * kPi * s / sides;
            ring.emplace_back(point.x * cosine(a), point.y, point.x * sine(a));
        }
        rings.push_back(std::move(ring));
    }
    addLoft(mesh, rings);
}

void addBevelledBar(Mesh& mesh, const BevelledBar& bar) {
    const double x = bar.width_x / 2.0;
    const double z = bar.depth_z / 2.0;
    const double b = bar.bevel;
    const auto middle = [&](double y) {
        const double t = y / bar.length;
        return glm::dvec3(bar.bow.x * 4.0 * t * (1.0 - t), y, bar.bow.y * 4.0 * t * (1.0 - t));
    };
    const std::array<glm::dvec2, 8> outline{{{x, -z + b},
                                             {x - b, -z},
                                             {-x + b, -z},
                                             {-x, -z + b},
                                             {-x, z - b},
                                             {-x + b, z},
                                             {x - b, z},
                                             {x, z - b}}};
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> last;
    for (int s = 0; s <= bar.segments; ++s) {
        const double y = b + (bar.length - 2.0 * b) * s / bar.segments;
        std::vector<std::uint32_t> ids;
        ids.reserve(outline.size());
        for (const glm::dvec2& p : outline)
            ids.push_back(mesh.addVertex(middle(y) + glm::dvec3(p.x, 0.0, p.y)));
        for (std::size_t i = 0; s > 0 && i < ids.size(); ++i)
            mesh.addQuad(last[i], last[(i + 1) % 8], ids[(i + 1) % 8], ids[i]);
        if (s == 0)
            first = ids;
        last = std::move(ids);
    }
    // Each end: a smaller rectangle, four bevel faces and four corner triangles.
    const auto close = [&](const std::vector<std::uint32_t>& ring, double y, bool top) {
        std::array<std::uint32_t, 4> cap{};
        for (std::size_t k = 0; k < 4; ++k) {
            const double sx = k == 0 || k == 3 ? x - b : b - x;
            const double sz = k < 2 ? b - z : z - b;
            cap[k] = mesh.addVertex(middle(y) + glm::dvec3(sx, 0.0, sz));
        }
        const auto face = [&](std::uint32_t a, std::uint32_t c, std::uint32_t d) {
            top ? mesh.addTriangle(a, c, d) : mesh.addTriangle(a, d, c);
        };
        for (std::size_t k = 0; k < 4; ++k) {
            const std::uint32_t from = ring[2 * k];
            const std::uint32_t to = ring[2 * k + 1];
            const std::uint32_t next = ring[(2 * k + 2) % 8];
            face(from, to, cap[k]);
            face(to, next, cap[(k + 1) % 4]);
            face(to, cap[(k + 1) % 4], cap[k]);
        }
        face(cap[0], cap[1], cap[2]);
        face(cap[0], cap[2], cap[3]);
    };
    close(first, 0.0, false);
    close(last, bar.length, true);
}

} // namespace lodestone::generate
