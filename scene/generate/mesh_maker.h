#pragma once
// Meshes from simple solids. Everything is built with shared vertices; hard edges are split once,
// when the mesh becomes a submesh.
#include "scene/generate/numbers.h"
#include "scene/scene.h"

#include <array>
#include <span>

namespace lodestone::generate {

// Triangles wind counter-clockwise seen from outside (for foliage: from above).
struct Mesh {
    std::vector<glm::dvec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;

    std::uint32_t addVertex(const glm::dvec3& p);
    void addTriangle(std::uint32_t a, std::uint32_t b, std::uint32_t c);
    void addQuad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d);
    // A fan over a convex loop of existing vertices.
    void addFan(std::span<const std::uint32_t> loop);
    void append(const Mesh& other, const glm::dmat4& transform = glm::dmat4(1.0));

    std::size_t triangleCount() const { return triangles.size(); }
};

glm::dmat4 moved(const glm::dvec3& offset);
glm::dmat4 scaled(const glm::dvec3& factors);
glm::dmat4 rotatedX(double angle);
glm::dmat4 rotatedY(double angle);
glm::dmat4 rotatedZ(double angle);

// 12 triangles.
void addBox(Mesh& mesh, const glm::dvec3& min, const glm::dvec3& max);

// A ring of points for loft(): any closed convex or star-shaped outline, counter-clockwise seen
// against the direction in which the rings follow each other.
using Ring = std::vector<glm::dvec3>;
enum class Ends { Capped, Open };

// Skin over rings of equal size (>= 3 points): 2 * size * (rings - 1) triangles, and
// 2 * (size - 2) for the caps.
void addLoft(Mesh& mesh, std::span<const Ring> rings, Ends ends = Ends::Capped);

// A point of a path with the radius of a tube around it.
struct PathPoint {
    glm::dvec3 position;
    double radius; // > 0
};

// A round tube of `sides` sides along a path of >= 2 points that does not turn back on itself.
// The frame is carried along, so the tube does not twist. Ends are flat caps.
void addTube(Mesh& mesh, std::span<const PathPoint> path, int sides, Ends ends = Ends::Capped);

// Upright, round about y: profile of (radius, height) from bottom to top, radii > 0.
void addTurned(Mesh& mesh, std::span<const glm::dvec2> profile, int sides);

// A bar along y from 0 to `length`, cross-section size.x by size.z, all edges bevelled, its middle
// line moved sideways by offset(t) at every one of `segments` joints, t in 0..1.
// 28 + 16 * segments triangles.
struct BevelledBar {
    double width_x = 0.1;
    double depth_z = 0.02;
    double length = 1.0;
    double bevel = 0.004; // < half of the smallest side
    int segments = 1;
    glm::dvec2 bow{0.0}; // sideways shift (x, z) of the middle, a parabola
};

void addBevelledBar(Mesh& mesh, const BevelledBar& bar);

// An icosphere whose every vertex is moved along its direction: 20 * 4^level triangles.
Mesh ball(int level);

// Splits the longest edges until the mesh has `triangle_count` triangles (no fewer than it has).
// Longest first, ties by index, so the result is fixed. A closed mesh grows by two at a time: the
// missing count must be even there.
void refineTo(Mesh& mesh, std::size_t triangle_count);

// Area-weighted normal of each vertex.
std::vector<glm::dvec3> vertexNormals(const Mesh& mesh);

// Float positions, NORMAL and indices; vertices are split along edges that turn by more than
// crease_angle (radians).
GeometryPtr makeGeometry(const Mesh& mesh, double crease_angle);

} // namespace lodestone::generate
