#pragma once
// Closed meshes of implicit surfaces, and making them evenly triangulated.
#include "scene/generate/mesh_maker.h"

#include <functional>

namespace lodestone::generate {

using Field = std::function<double(const glm::dvec3&)>; // < 0 inside; called from any thread

struct Grid {
    glm::dvec3 min{0.0};
    double cell = 0.1;
    glm::ivec3 cells{1}; // the surface must stay inside the grid
};

// Marching tetrahedra (Doi, Koide 1991) on six tetrahedra a cell: closed and manifold whatever the
// field. O(cells); the field is sampled in parallel.
Mesh polygonize(const Field& field, const Grid& grid);

// Collapses edges, the shortest relative to size(middle) first, until triangle_count is reached.
// Stays closed and manifold and keeps the genus; triangle_count even. Ends early when no edge can
// go. O(n log n).
void coarsen(Mesh& mesh, std::size_t triangle_count, const Field& size);

// Moves vertices towards the middle of their neighbours, within the surface, and back onto it.
void relax(Mesh& mesh, const Field& field, int rounds);

// Central differences, step 1e-4; points out of the surface.
glm::dvec3 gradient(const Field& field, const glm::dvec3& p);

} // namespace lodestone::generate
