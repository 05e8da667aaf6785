#pragma once
// The metric of Wild (Liu et al. 2024) on the mesh and the collapse operator that all edge-collapse
// methods share: planes with memory, area without, virtual edges, no validity checks.
#include "simplify/collapse/component_mesh.h"

namespace lodestone {

struct WildOptions {
    double area_weight = 1.0; // of the squared area that borders sweep, >= 0
    bool checks = false;      // keep topology, turn no face; for input known to be manifold
    // [primitives] faces on the same three vertices are one, whichever way they face. Else only
    // those that face the same way are.
    std::vector<bool> two_sided;
};

class WildMesh : public ComponentMesh {
public:
    // The arguments outlive the mesh.
    WildMesh(const Complex& complex,
             const InstanceWeights& weights,
             const WedgeAttributes& attributes,
             const CollapseOptions& options,
             const WildOptions& wild);

    void load(std::size_t component);

    using Edge = std::array<std::uint32_t, 2>;

    // The 1-simplices at the start: every edge of a face and every virtual edge, once.
    std::vector<Edge> edges();

    std::uint32_t valence(std::uint32_t v) const { return rings_[v].count; }

    // What the queue orders by, >= 0.
    float key(std::uint32_t a, std::uint32_t b) { return place(a, b).key; }

    // Collapses b into a if strictness allows, and logs the step.
    bool collapse(std::uint32_t a, std::uint32_t b, Strictness strictness);

    // Right after b has collapsed into a: calls visit(x, y) for edges, by their number in edges(),
    // that have become the same. Those of faces that died with their edge; others go unnoticed.
    template <class Visit>
    void visitCoinciding(std::uint32_t a, std::uint32_t b, Visit visit) const {
        for (const std::uint32_t face : dying_) {
            std::array<std::uint32_t, 2> sides;
            std::size_t count = 0;
            for (std::size_t k = 0; k < 3; ++k)
                if (const std::uint32_t v = faces_[face][k]; v == a || v == b)
                    sides[count++ % 2] = face_edges_[face][k];
            if (count == 2)
                visit(sides[0], sides[1]);
        }
    }

private:
    // Squared area that the borders at a vertex sweep when it moves, about it (Lindstrom and Turk
    // 1998). Without memory: reckoned from the mesh as it is now, when asked for.
    struct Area {
        float xx = 0.0f, yy = 0.0f, zz = 0.0f, xy = 0.0f, xz = 0.0f, yz = 0.0f;
        float weight = 0.0f; // sum of the squared lengths of the borders
        bool stale = true;
    };

    // What the faces on an edge at a vertex say about it.
    struct Side {
        std::uint32_t other = 0; // end of the edge
        std::uint32_t faces = 0;
        Float3 along;                 // to the end
        std::array<Float3, 2> thirds; // to the third corners of the first two faces
        Float3 sum; // of the unit directions in which faces lie off the edge, of three or more
    };

    const Area& areaOf(std::uint32_t v);
    void gatherSides(std::uint32_t v);
    static bool isBorder(const Side& side);
    void addBorder(Area& area, Float3 edge) const;
    Quadric areaQuadric(std::uint32_t v);
    Placement place(std::uint32_t a, std::uint32_t b);
    float dearness(std::uint32_t a, std::uint32_t b) const;
    float longestEdge2(std::uint32_t v) const;
    void dropDoubles();
    bool isDouble(const RingFace& face) const;
    bool twoSided(std::uint32_t face) const;
    void touchAround(std::uint32_t a, std::span<const std::uint32_t> dead);

    const WildOptions& wild_;
    glm::dmat3 border_metric_; // what a vector area counts over all instances
    std::size_t component_ = 0;
    std::vector<Area> areas_;                              // [vertices]
    std::vector<Side> sides_;                              // scratch
    std::vector<std::array<std::uint32_t, 3>> face_edges_; // [faces] opposite each corner
};

struct LazyGreedyOptions {
    Strictness first = Strictness::Anything; // what is tried before liberties are taken
    // Components with more faces are collapsed in passes down to the second number.
    std::uint32_t passes_above = 24'000;
    std::uint32_t passes_until = 6'000;
};

// Collapses until nothing is left to collapse, the cheapest pair first. Costs are refreshed when
// their pair comes up, not when they change: around virtual edges valences explode. False if
// stopped.
bool collapseLazily(WildMesh& mesh, const LazyGreedyOptions& options, const CollapseWatch& watch);

} // namespace lodestone
