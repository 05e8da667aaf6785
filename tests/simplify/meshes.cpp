#include "tests/simplify/meshes.h"

#include "scene/scene_builder.h"

#include <array>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <map>
#include <numbers>
#include <random>

namespace lodestone::meshes {

namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

void addQuad(Geometry& to, std::array<std::uint32_t, 4> corners) {
    const auto [a, b, c, d] = corners;
    for (const std::uint32_t index : {a, b, c, a, c, d})
        to.indices.push_back(index);
}

} // namespace

GeometryPtr sphere(int rings, int segments, double bump) {
    auto geometry = std::make_shared<Geometry>();
    const auto add = [&](double polar, double around) {
        const double radius = 1.0 + bump * std::sin(5.0 * polar) * std::cos(3.0 * around);
        geometry->positions.emplace_back(radius * std::sin(polar) * std::cos(around),
                                         radius * std::sin(polar) * std::sin(around),
                                         radius * std::cos(polar));
    };
    add(0.0, 0.0);
    for (int r = 1; r < rings; ++r)
        for (int s = 0; s < segments; ++s)
            add(std::numbers::pi * r / rings, kTurn * s / segments);
    add(std::numbers::pi, 0.0);
    const auto at = [&](int r, int s) {
        if (r == 0)
            return 0u;
        if (r == rings)
            return static_cast<std::uint32_t>(geometry->positions.size() - 1);
        return static_cast<std::uint32_t>(1 + (r - 1) * segments + s % segments);
    };
    for (int r = 0; r < rings; ++r)
        for (int s = 0; s < segments; ++s) {
            if (r > 0)
                for (const std::uint32_t index : {at(r, s), at(r + 1, s), at(r, s + 1)})
                    geometry->indices.push_back(index);
            if (r + 1 < rings)
                for (const std::uint32_t index : {at(r, s + 1), at(r + 1, s), at(r + 1, s + 1)})
                    geometry->indices.push_back(index);
        }
    return geometry;
}

GeometryPtr torus(int major, int minor) {
    auto geometry = std::make_shared<Geometry>();
    for (int i = 0; i < major; ++i)
        for (int j = 0; j < minor; ++j) {
            const double u = kTurn * i / major;
            const double v = kTurn * j / minor;
            const double radius = 1.0 + 0.4 * std::cos(v);
            geometry->positions.emplace_back(
                radius * std::cos(u), radius * std::sin(u), 0.4 * std::sin(v));
        }
    const auto at = [&](int i, int j) {
        return static_cast<std::uint32_t>(i % major * minor + j % minor);
    };
    for (int i = 0; i < major; ++i)
        for (int j = 0; j < minor; ++j)
            addQuad(*geometry, {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    return geometry;
}

GeometryPtr grid(int quads_per_side) {
    auto geometry = std::make_shared<Geometry>();
    const int row = quads_per_side + 1;
    for (int y = 0; y < row; ++y)
        for (int x = 0; x < row; ++x)
            geometry->positions.emplace_back(glm::dvec3(x, y, 0.0) / double(quads_per_side));
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(y * row + x); };
    for (int y = 0; y < quads_per_side; ++y)
        for (int x = 0; x < quads_per_side; ++x)
            addQuad(*geometry, {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
    return geometry;
}

GeometryPtr card(int quads_per_side) {
    auto geometry = std::make_shared<Geometry>(*grid(quads_per_side));
    const auto vertices = static_cast<std::uint32_t>(geometry->positions.size());
    const std::size_t indices = geometry->indices.size();
    for (std::uint32_t v = 0; v < vertices; ++v)
        geometry->positions.push_back(glm::vec3(geometry->positions[v]));
    for (std::size_t i = 0; i < indices; i += 3)
        for (const std::size_t corner : {i, i + 2, i + 1})
            geometry->indices.push_back(geometry->indices[corner] + vertices);
    return geometry;
}

GeometryPtr soup(int triangles) {
    auto geometry = std::make_shared<Geometry>();
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (int i = 0; i < 3 * triangles; ++i) {
        const float x = unit(random);
        const float y = unit(random);
        geometry->positions.emplace_back(x, y, unit(random));
        geometry->indices.push_back(static_cast<std::uint32_t>(i));
    }
    return geometry;
}

GeometryPtr moved(const GeometryPtr& geometry, const glm::dvec3& by) {
    auto other = std::make_shared<Geometry>(*geometry);
    for (glm::vec3& position : other->positions)
        position = glm::vec3(glm::dvec3(position) + by);
    return other;
}

GeometryPtr
withAttribute(const Geometry& geometry, std::string semantic, std::span<const float> values) {
    auto other = std::make_shared<Geometry>(geometry);
    Attribute attribute;
    attribute.semantic = std::move(semantic);
    attribute.components = static_cast<std::uint8_t>(values.size() / geometry.positions.size());
    attribute.bytes.resize(values.size_bytes());
    std::memcpy(attribute.bytes.data(), values.data(), values.size_bytes());
    other->attributes.push_back(std::move(attribute));
    return other;
}

Submesh submeshOf(std::vector<GeometryPtr> primitives) {
    Submesh submesh;
    submesh.name = "shape";
    for (GeometryPtr& geometry : primitives) {
        submesh.primitives.emplace_back();
        submesh.primitives.back().geometry = std::move(geometry);
    }
    return submesh;
}

ScenePtr sceneOf(std::vector<Submesh> submeshes, std::vector<std::vector<glm::dmat4>> transforms) {
    SceneBuilder builder("made");
    for (std::size_t s = 0; s < submeshes.size(); ++s) {
        const std::uint32_t submesh = builder.addSubmesh(std::move(submeshes[s]));
        for (const glm::dmat4& transform : transforms[s])
            builder.addNode("instance", kNone, transform, submesh);
    }
    return builder.finish();
}

std::vector<glm::dmat4> gridOfTransforms(int per_side, double spacing) {
    std::vector<glm::dmat4> transforms;
    for (int y = 0; y < per_side; ++y)
        for (int x = 0; x < per_side; ++x)
            transforms.push_back(glm::translate(glm::dmat4(1.0), spacing * glm::dvec3(x, y, 0.0)));
    return transforms;
}

CollapseSequence sequenceOf(const Submesh& submesh,
                            const CollapseOptions& options,
                            const FloorOptions& floors,
                            std::uint32_t instance_count) {
    SequenceRequest request;
    request.submesh = &submesh;
    request.instance_count = instance_count;
    return std::move(buildSequences(std::span(&request, 1), options, floors, {}).value()[0]);
}

std::vector<GeometryPtr>
readAt(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step) {
    return readOutSubmesh(sequence, submesh, step, 1.0, glm::dvec3(0.0));
}

Shape shapeOf(std::span<const GeometryPtr> primitives) {
    using Place = std::array<float, 3>;
    Shape shape;
    std::map<std::pair<Place, Place>, std::uint32_t> edges;
    for (const GeometryPtr& geometry : primitives)
        for (std::size_t t = 0; t < geometry->triangleCount(); ++t) {
            std::array<Place, 3> place;
            std::array<glm::dvec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::vec3& p = geometry->positions[geometry->indices[3 * t + k]];
                place[k] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
                corner[k] = glm::dvec3(p);
                shape.bounds.add(corner[k]);
                for (int axis = 0; axis < 3; ++axis)
                    shape.finite = shape.finite && std::isfinite(p[axis]);
            }
            ++shape.faces;
            if (place[0] == place[1] || place[1] == place[2] || place[2] == place[0])
                ++shape.degenerate_faces;
            for (std::size_t k = 0; k < 3; ++k)
                ++edges[std::minmax(place[k], place[(k + 1) % 3])];
            shape.area +=
                0.5 * glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        }
    for (const auto& [edge, uses] : edges) {
        shape.border_edges += uses == 1 ? 1 : 0;
        shape.non_manifold_edges += uses > 2 ? 1 : 0;
    }
    return shape;
}

} // namespace lodestone::meshes
