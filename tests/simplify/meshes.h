#pragma once
// Small meshes of every asset class, and what tests ask of a mesh: borders, area, turned faces.
#include "simplify/collapse/edge_collapse_source.h"

#include <span>
#include <tuple>

namespace lodestone::meshes {

// A bumpy sphere: closed, every vertex shared; 2 * segments * (rings - 1) triangles.
GeometryPtr sphere(int rings, int segments, double bump = 0.1);
// Closed, of genus one; 2 * major * minor triangles.
GeometryPtr torus(int major, int minor);
// Unit square at z = 0 in quads_per_side^2 quads, shared vertices, no attributes.
GeometryPtr grid(int quads_per_side);
// The same with a second layer facing the other way on the same positions.
GeometryPtr card(int quads_per_side);
// Triangles that share no vertex, in the unit cube.
GeometryPtr soup(int triangles);
GeometryPtr moved(const GeometryPtr& geometry, const glm::dvec3& by);
// Attaches a float attribute; values: components floats a vertex.
GeometryPtr
withAttribute(const Geometry& geometry, std::string semantic, std::span<const float> values);

Submesh submeshOf(std::vector<GeometryPtr> primitives);
// transforms: [submeshes][their instances]
ScenePtr sceneOf(std::vector<Submesh> submeshes, std::vector<std::vector<glm::dmat4>> transforms);
std::vector<glm::dmat4> gridOfTransforms(int per_side, double spacing);

// One submesh, one plain instance, no floors unless given.
CollapseSequence sequenceOf(const Submesh& submesh,
                            const CollapseOptions& options = {},
                            const FloorOptions& floors = {},
                            std::uint32_t instance_count = 1);
std::vector<GeometryPtr>
readAt(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step);

// Of the mesh that all primitives make together, welded by position.
struct Shape {
    std::uint32_t faces = 0;
    std::uint32_t border_edges = 0;       // in one face
    std::uint32_t non_manifold_edges = 0; // in more than two
    std::uint32_t degenerate_faces = 0;   // two corners at one place
    double area = 0.0;
    Bounds bounds;
    bool finite = true;
};

// Orders places, so that equal ones can be found.
struct LessByPlace {
    bool operator()(const glm::vec3& a, const glm::vec3& b) const {
        return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
    }
};

Shape shapeOf(std::span<const GeometryPtr> primitives);

} // namespace lodestone::meshes
