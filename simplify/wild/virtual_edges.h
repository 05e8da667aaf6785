#pragma once
// Virtual edges: pairs of vertices of different components that may merge, because what an artist
// joins by putting parts against each other shares no vertex.
#include "scene/job_context.h"
#include "simplify/collapse/complex.h"

namespace lodestone {

// What has to be near for two components to get a virtual edge.
enum class VirtualEdgeRule : std::uint8_t {
    Triangles, // two triangles (Wild, section 5.1)
    Vertices,  // two vertices (Garland and Heckbert 1997)
};

struct VirtualEdgeOptions {
    double epsilon = 0.0; // largest distance, of the diagonal of the complex's bulk; 0: no edges
    VirtualEdgeRule rule = VirtualEdgeRule::Triangles;
};

// Adds virtual edges to a complex and joins the components that they connect, so that a component
// is what can become one piece. For two near triangles the edge leads between the vertices nearest
// to their closest points; of those that a vertex has to one other component only the shortest
// stays, and only if it is the other end's shortest, too; at most 8 at a vertex.
// Parallel, the same for any number of threads; stops early where asked to.
// O(faces log faces + pairs of near faces). Source: Wild (Liu et al. 2024), section 5.
void addVirtualEdges(Complex& complex, const VirtualEdgeOptions& options, const JobContext& job);

} // namespace lodestone
