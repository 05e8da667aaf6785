#include "render/frame_points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::size_t kSceneDirections = 200;
constexpr std::size_t kLocalDirections = 64; // per submesh; it keeps that many vertices at most
constexpr std::size_t kAllKept = 64;         // submeshes of so few vertices keep all

// Evenly spread over the sphere (Fibonacci's spiral).
std::vector<glm::dvec3> directions(std::size_t count) {
    const double turn = std::numbers::pi * (3.0 - std::sqrt(5.0));
    std::vector<glm::dvec3> found(count);
    for (std::size_t i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * static_cast<double>(i) + 1.0) / static_cast<double>(count);
        const double radius = std::sqrt(std::max(0.0, 1.0 - y * y));
        const double angle = turn * static_cast<double>(i);
        found[i] = {std::cos(angle) * radius, y, std::sin(angle) * radius};
    }
    return found;
}

// What stands for a submesh: its outermost vertices and a sphere around them.
struct Extremes {
    std::vector<glm::dvec3> points;
    glm::dvec3 center{0.0};
    double radius = 0.0;
};

bool hasTriangles(const Scene& scene) {
    return std::any_of(scene.instances.begin(), scene.instances.end(), [&](const Instance& one) {
        return triangleCount(scene.submeshes[one.submesh]) > 0;
    });
}

// Points and lines count where there is nothing else: a stray line is not worth a distant view.
enum class Counted : std::uint8_t { Triangles, Everything };

// The vertices that an instance shows.
std::vector<glm::vec3> drawnVertices(const Submesh& submesh, Counted counted) {
    std::vector<glm::vec3> vertices;
    for (const Primitive& primitive : submesh.primitives) {
        const Geometry& geometry = *primitive.geometry;
        const bool is_triangles = primitive.mode == PrimitiveMode::Triangles;
        if (!is_triangles && counted == Counted::Triangles)
            continue;
        if (!is_triangles && geometry.indices.empty()) {
            vertices.insert(vertices.end(), geometry.positions.begin(), geometry.positions.end());
            continue;
        }
        std::vector<bool> used(geometry.positions.size(), false);
        for (const std::uint32_t index : geometry.indices)
            used[index] = true;
        for (std::size_t v = 0; v < used.size(); ++v)
            if (used[v])
                vertices.push_back(geometry.positions[v]);
    }
    return vertices;
}

Extremes extremesOf(const Submesh& submesh, Counted counted) {
    const std::vector<glm::vec3> vertices = drawnVertices(submesh, counted);
    Extremes extremes;
    std::vector<std::size_t> kept;
    if (vertices.size() <= kAllKept) {
        for (std::size_t v = 0; v < vertices.size(); ++v)
            kept.push_back(v);
    } else {
        for (const glm::dvec3& direction : directions(kLocalDirections)) {
            const glm::vec3 narrow(direction);
            std::size_t farthest = 0;
            float most = -std::numeric_limits<float>::infinity();
            for (std::size_t v = 0; v < vertices.size(); ++v)
                if (const float along = glm::dot(vertices[v], narrow); along > most) {
                    most = along;
                    farthest = v;
                }
            kept.push_back(farthest);
        }
        std::sort(kept.begin(), kept.end());
        kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    }
    Bounds box;
    for (const std::size_t v : kept) {
        extremes.points.emplace_back(vertices[v]);
        box.add(extremes.points.back());
    }
    extremes.center = box.center();
    for (const glm::dvec3& point : extremes.points)
        extremes.radius = std::max(extremes.radius, glm::length(point - extremes.center));
    return extremes;
}

struct Ball {
    glm::dvec3 center;
    double radius = 0.0;
};

Ball worldBall(const Extremes& extremes, const glm::dmat4& transform) {
    // The Frobenius norm is never less than the largest stretch.
    double squared = 0.0;
    for (int c = 0; c < 3; ++c)
        squared += glm::dot(glm::dvec3(transform[c]), glm::dvec3(transform[c]));
    return {glm::dvec3(transform * glm::dvec4(extremes.center, 1.0)),
            extremes.radius * std::sqrt(squared)};
}

bool isInside(const Bounds& bounds, const glm::dvec3& point) {
    const double slack = bounds.diagonal() * 1e-6;
    return glm::all(glm::greaterThanEqual(point, bounds.min - slack)) &&
           glm::all(glm::lessThanEqual(point, bounds.max + slack));
}

struct Support {
    glm::dvec3 point{0.0};
    double along = -std::numeric_limits<double>::infinity();
};

} // namespace

FramePoints framePoints(const Scene& scene) {
    return framePoints(scene, robustWorldBounds(scene));
}

FramePoints framePoints(const Scene& scene, const Bounds& bounds) {
    FramePoints frame;
    frame.bounds = bounds;
    if (bounds.empty)
        return frame;
    const Counted counted = hasTriangles(scene) ? Counted::Triangles : Counted::Everything;
    std::vector<Extremes> extremes(scene.submeshes.size());
    tbb::parallel_for(std::size_t(0), extremes.size(), [&](std::size_t s) {
        extremes[s] = extremesOf(scene.submeshes[s], counted);
    });
    std::vector<Ball> balls(scene.instances.size());
    for (std::size_t i = 0; i < balls.size(); ++i)
        balls[i] = worldBall(extremes[scene.instances[i].submesh], scene.instances[i].transform);
    const std::vector<glm::dvec3> wanted = directions(kSceneDirections);
    std::vector<Support> supports(wanted.size());
    tbb::parallel_for(std::size_t(0), wanted.size(), [&](std::size_t d) {
        Support& support = supports[d];
        for (std::size_t i = 0; i < balls.size(); ++i) {
            if (!(glm::dot(balls[i].center, wanted[d]) + balls[i].radius > support.along))
                continue;
            const Instance& instance = scene.instances[i];
            for (const glm::dvec3& local : extremes[instance.submesh].points) {
                const glm::dvec3 point(instance.transform * glm::dvec4(local, 1.0));
                const double along = glm::dot(point, wanted[d]);
                if (along > support.along && isInside(bounds, point))
                    support = {point, along};
            }
        }
    });
    for (const Support& support : supports)
        if (std::isfinite(support.along))
            frame.points.push_back(support.point);
    return frame;
}

FramePoints framePoints(const Bounds& bounds) {
    FramePoints frame;
    frame.bounds = bounds;
    if (bounds.empty)
        return frame;
    for (unsigned corner = 0; corner < 8; ++corner)
        frame.points.emplace_back((corner & 1u) != 0 ? bounds.max.x : bounds.min.x,
                                  (corner & 2u) != 0 ? bounds.max.y : bounds.min.y,
                                  (corner & 4u) != 0 ? bounds.max.z : bounds.min.z);
    return frame;
}

} // namespace lodestone
