#pragma once
// What removing instances needs to know of a submesh.
#include "scene/scene.h"

#include <array>

namespace lodestone {

// In the submesh's own space.
struct SubmeshFacts {
    double area = 0.0;
    glm::dvec3 color{1.0}; // area-weighted, about as bright as it looks
    // Of submeshes with several instances:
    Bounds bounds;
    std::array<glm::dvec3, 4> points{}; // evenly along the triangles' area
    glm::dvec3 pivot{0.0};              // of growing
    glm::dmat3 normal_moment{0.0};      // area-weighted mean of n n^T
};

// instances: of the submesh. O(triangles), any thread.
SubmeshFacts factsOf(const Scene& scene, const Submesh& submesh, std::size_t instances);

} // namespace lodestone
