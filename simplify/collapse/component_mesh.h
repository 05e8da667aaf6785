#pragma once
// One connected component while it is being collapsed: the edge-collapse operator that every way of
// picking edges shares, and the log that a sequence is made of.
#include "scene/job_context.h"
#include "simplify/collapse/complex.h"
#include "simplify/collapse/instance_weights.h"
#include "simplify/collapse/quadric.h"
#include "simplify/collapse/wedge_attributes.h"
#include "simplify/collapse/wedge_quadric.h"

#include <atomic>
#include <memory>

namespace lodestone {

// How much attributes count beside the shape; 0: not at all.
struct AttributeWeights {
    double texcoord = 0.5; // 1: a texture sliding by some way counts as a surface off by as much
    double normal = 0.2;   // 1: a radian counts as a surface off by an edge's length
    double color = 0.25;   // 1: black for white counts as a surface off by an edge's length
    double motion = 0.03;  // 1: off in a morph target or a joint's motion counts as off at rest
};

class CollapseMethod;

struct CollapseOptions {
    double boundary_weight = 1.0;    // x the squared edge length, >= 0
    bool boundary_by_length = false; // paper-literal: weight by length instead of squared length
    double silhouette_weight = 0.0;  // x the squared edge length and the share of directions, >= 0
    double flip_angle_deg = 80.0;    // collapses that turn a face further are rejected, 0..180
    AttributeWeights attributes;
    // Collapses that end a seam or merge two, 0..1. 0: never. Else they cost 1 / this more.
    double seams = 1.0;
    // Components with more faces are picked in near-greedy passes down to the second number.
    std::uint32_t near_greedy_above = 24'000;
    std::uint32_t exact_below = 6'000;
    bool grow_crowds = false; // what is left of many small open parts, as leaves, keeps their area
    std::shared_ptr<const CollapseMethod> method; // null: each component's edges, greedily
};

// What happened to one component, in local ids; step numbers start at 1.
struct CollapseLog {
    std::vector<float> cost;   // [steps] quadric error, in the complex's units, unscaled weights
    std::vector<float> error2; // [steps] squared distance it stands for, in the complex's units
    std::vector<std::uint32_t> faces;        // [faces] ids in the complex
    std::vector<std::uint32_t> face_death;   // [faces] step, kNone: survives
    std::vector<std::uint32_t> wedges;       // [wedges] ids in the complex
    std::vector<std::uint32_t> wedge_death;  // [wedges] step, kNone: survives
    std::vector<std::uint32_t> wedge_parent; // [wedges] the wedge it became, kNone: just gone
    std::vector<std::uint32_t> kill_order;   // dead wedges, earliest first
    // Where a wedge lies from a step on.
    std::vector<std::uint32_t> version_wedge;
    std::vector<std::uint32_t> version_step;
    std::vector<glm::vec3> version_position;    // in the submesh's units
    std::vector<std::uint32_t> version_carrier; // local wedge whose other attributes it takes
    std::vector<float> version_values;          // [versions * WedgeAttributes::size]

    std::uint32_t stepCount() const { return static_cast<std::uint32_t>(cost.size()); }
};

enum class Strictness : std::uint8_t {
    Manifold, // topology is kept, faces do not turn over
    Upright,  // topology may change, faces do not turn over
    Anything, // every edge goes
};

class ComponentMesh {
public:
    ComponentMesh(const Complex& complex,
                  const InstanceWeights& weights,
                  const WedgeAttributes& attributes,
                  const CollapseOptions& options);

    // Loads a component; keeps the memory of the last one.
    void load(std::size_t component);

    std::size_t vertexCount() const { return points_.size(); }

    std::uint32_t liveFaces() const { return live_faces_; }

    bool alive(std::uint32_t v) const { return rings_[v].count > 0; }

    std::uint32_t version(std::uint32_t v) const { return rings_[v].version; } // rises with changes

    bool movable(std::uint32_t a, std::uint32_t b) const {
        return !metrics_[a].locked && !metrics_[b].locked;
    }

    Placement place(std::uint32_t a, std::uint32_t b);

    // Hints that a vertex will be looked at soon: first its ring's place, later the ring itself.
    void prefetchRing(std::uint32_t v) const {
        __builtin_prefetch(&rings_[v]);
        __builtin_prefetch(&points_[v]);
        __builtin_prefetch(&metrics_[v]);
        if (!vertex_ids_.empty())
            __builtin_prefetch(&vertex_ids_[v]);
    }

    void prefetchReferences(std::uint32_t v) const {
        __builtin_prefetch(refs_.data() + rings_[v].begin);
        if (vertex_ids_.empty())
            return;
        __builtin_prefetch(&log_.wedge_death[vertex_ids_[v]]);
        __builtin_prefetch(values_.data() + std::size_t{vertex_ids_[v]} * attributes_.size);
        if (wedge_quadrics_.active())
            wedge_quadrics_.prefetch(vertex_ids_[v]);
    }

    void prefetchFaces(std::uint32_t v) const {
        for (const std::uint32_t face : facesAround(v))
            __builtin_prefetch(&faces_[face]);
    }

    // The vertices that share a live face with v and are accepted, and the keys of their edges with
    // v. Valid until the next call.
    struct Spokes {
        std::span<const std::uint32_t> others;
        std::span<const float> keys;
    };
    template <class Accept>
    Spokes costSpokes(std::uint32_t v, Accept accept);

    // Collapses b into a at the placement if strictness allows, and logs the step.
    bool tryCollapse(std::uint32_t a,
                     std::uint32_t b,
                     const Placement& placement,
                     Strictness strictness);

    std::uint32_t stepCount() const { return log_.stepCount(); }

    // The vertices that the last collapse looked at, and those whose place or faces it changed;
    // some more than once. Two collapses of different ends in which neither looks at what the
    // other changed may change places.
    template <class Visit>
    void visitReadByCollapse(Visit visit) const;
    template <class Visit>
    void visitChangedByCollapse(Visit visit) const;

    // Puts the steps after `first_step` into another order: order[i] is the place, from there, of
    // the one that is to be at i. No vertex may be an end of two of them.
    void reorderSteps(std::uint32_t first_step, std::span<const std::uint32_t> order);

    // Moves what is alive together again, once half the faces are dead: later work stays in cache.
    // Result: new number of each vertex, kNone for the dead; empty if nothing was moved.
    std::span<const std::uint32_t> compact();

    CollapseLog takeLog();
    double costScale() const; // x a logged cost: cost in the submesh's own units, unscaled weights

protected: // what another metric on the same mesh builds on
    using Corners = std::array<std::uint32_t, 3>;
    static constexpr std::array<std::uint8_t, 3> kNext{1, 2, 0};
    static constexpr std::array<std::uint8_t, 3> kLast{2, 0, 1};

    // Which corner of a face its vertex is. No branch: that cannot be foreseen.
    static std::size_t cornerOf(const Corners& face, std::uint32_t v) {
        return static_cast<std::size_t>(face[1] == v) + 2 * static_cast<std::size_t>(face[2] == v);
    }

    // Vertices by what is read together: checks look at many points, costing at few metrics.
    struct Point {
        Float3 position;        // relative to origin, over scale
        std::uint32_t mark = 0; // a stamp
    };

    struct Metric {
        Quadric quadric;
        bool boundary = false;
        bool locked = false;
        bool extreme = false; // keeps its place as far as that is cheap
    };

    struct Ring { // live faces around a vertex: a range of refs_
        std::uint32_t begin = 0;
        std::uint32_t count = 0;
        std::uint32_t capacity = 0;
        std::uint32_t version = 0;
    };

    // A face around a vertex, seen from it.
    struct RingFace {
        std::uint32_t face = 0;
        std::uint32_t next = 0; // the corner after the vertex
        std::uint32_t last = 0; // the corner before it
    };

    // Four of them side by side; where fewer are left, faces without an area.
    struct RingBlock {
        Vector3<Float4> next; // position of the corner after the vertex
        Vector3<Float4> side; // from there to the corner before the vertex
        Vector3<Float4> area; // normal, as long as twice the area
    };

    void buildVertices(std::size_t component);
    void placeVertices(std::span<const std::uint32_t> ids);
    void buildReferences();
    void fillRings();
    void buildWedges();
    void gatherValues();
    void buildQuadrics();
    void addFaceQuadric(std::uint32_t face);
    void holdExtremes();
    float faceWeight(std::uint32_t face, float area) const; // 0: counts for nothing
    void chooseValues();
    float valueScale(std::uint32_t primitive, const WedgeAttributes::Slot& slot) const;
    float texcoordScale(std::uint32_t primitive, const WedgeAttributes::Slot& slot) const;
    void buildWedgeQuadrics();
    void scaledValues(std::uint32_t wedge, std::span<float> out) const;
    bool seamBetween(std::uint32_t face_a, std::uint32_t face_b, std::uint32_t vertex) const;
    bool closesFan(std::uint32_t a);
    void addBoundaryQuadrics(std::uint32_t a);
    void addBoundaryQuadric(std::uint32_t a, std::uint32_t b, std::uint32_t face);
    void addSilhouetteQuadric(std::uint32_t a, std::uint32_t b, Float3 normal_a, Float3 normal_b);
    Float3 faceNormal(const Corners& face) const; // not normalised

    // Two faces on an edge that are this close to lying back to back are a border, not a fold: the
    // rims of two-sided cards. Cosine between the unit normals.
    static constexpr float kBackToBack = -0.98f;

    bool folded(std::uint32_t face_a, std::uint32_t face_b) const;

    // Which wedges count when spokes are costed.
    enum class SpokeWedges : std::uint8_t { None, OneEach, Several };
    // Keys of the spokes' edges, four at a time.
    template <SpokeWedges wedges>
    void costSpokeEdges(std::uint32_t v);
    void addMerges(const std::array<std::size_t, 4>& spokes,
                   const Vector3<Float4>& half,
                   QuadricOf<Float4>& sum) const;
    void gatherSpokePairs(std::uint32_t v);
    void gatherRings(std::uint32_t a, std::uint32_t b);
    bool keepsTopology(std::uint32_t a, std::uint32_t b);
    Float3 towardsVolume(std::uint32_t a, std::uint32_t b, Float3 at, Float3 half);
    Vector3<Float4> positionsOf(const std::array<std::uint32_t, 4>& vertices) const;
    Float3 gatherBlocks(std::span<const RingFace> ring, std::uint32_t v);
    bool staysUpright(Float3 to) const;
    bool hasFace(std::span<const RingFace> ring, std::uint32_t x, std::uint32_t y) const;

    // Error of a collapse as it is logged.
    struct StepError {
        float cost = 0.0f;
        float error2 = 0.0f;
    };

    // Collapses b into a at target and logs the step. The rings are gathered; dying_ may also hold
    // faces around b alone, which are then not in ring_b_.
    void merge(std::uint32_t a,
               std::uint32_t b,
               Float3 target,
               const Quadric& merged,
               const StepError& error);
    void mergeFaces(std::uint32_t a, std::uint32_t b);
    void killFace(std::uint32_t face);
    void dropReference(std::uint32_t v, std::uint32_t face);
    bool releasesSeam(std::uint32_t a, std::uint32_t b) const;
    std::uint32_t wedgeAt(std::uint32_t face, std::uint32_t vertex) const;
    void pairWedges(std::uint32_t a, std::uint32_t b);
    Quadric mergeWedgeQuadrics(std::uint32_t a, std::uint32_t b, Float3 target);
    void mergeSingleWedges(std::uint32_t a, std::uint32_t b, float t);
    void mergeWedges(std::uint32_t a, float t);
    void takeBestValues(std::uint32_t wedge);
    void killWedge(std::uint32_t wedge, std::uint32_t parent);
    void releaseWedge(std::uint32_t wedge);
    void addVersion(std::uint32_t wedge, Float3 position);
    void blendValues(std::uint32_t into, std::uint32_t from, float t);
    void moveAlike(std::uint32_t wedge, std::uint32_t like);

    std::span<const std::uint32_t> facesAround(std::uint32_t v) const {
        return {refs_.data() + rings_[v].begin, rings_[v].count};
    }

    std::uint32_t nextStamp() { return ++stamp_; }

    std::uint32_t step() const { return log_.stepCount(); }

    const Complex& complex_;
    const InstanceWeights& weights_;
    const WedgeAttributes& attributes_;
    const CollapseOptions& options_;
    float flip_cosine2_ = 0.0f; // squared cosine of the flip angle
    bool flip_sharp_ = true;    // flip angle below 90 degrees

    glm::dvec3 origin_{0.0};
    double scale_ = 1.0;
    std::vector<Point> points_;                  // [vertices]
    std::vector<Metric> metrics_;                // [vertices]
    std::vector<Ring> rings_;                    // [vertices]
    std::vector<Corners> faces_;                 // [faces] local vertices; dead: face_death set
    std::vector<Corners> face_wedges_;           // [faces] local wedges; empty: one a vertex
    std::vector<std::uint32_t> face_ids_;        // [faces] in the log
    std::vector<std::uint32_t> vertex_ids_;      // [vertices] in the log, where it is its own wedge
    std::vector<std::uint32_t> moved_to_;        // scratch of compact()
    std::vector<std::uint32_t> refs_;            // faces of each vertex
    std::vector<std::uint32_t> wedge_refs_;      // [wedges] live corners; empty: one a vertex
    std::vector<std::uint32_t> wedge_carrier_;   // [wedges]
    std::vector<float> values_;                  // [wedges * size]
    std::vector<std::uint32_t> wedge_primitive_; // [wedges]
    WedgeQuadrics wedge_quadrics_;
    std::vector<Quadric> shapes_; // [vertices] without attributes; empty: metrics_ have none

    // Which of a wedge's values count, [primitives][WedgeQuadrics::valueCount() at most].
    struct CountedValue {
        std::uint32_t offset = 0;
        float scale = 0.0f; // makes it a length
        float low = 0.0f;
        float high = 0.0f;
        bool unit = false; // the first of three that make a unit vector
    };

    std::vector<std::vector<CountedValue>> counted_;
    float motion_scale_ = 0.0f;               // 0: motion does not count
    std::vector<std::uint32_t> wedge_counts_; // [vertices] empty: one each, or seams are free to go
    std::uint32_t live_faces_ = 0;

    std::vector<Float3> normals_;          // [faces] unit, at the start; 0 where degenerate
    std::vector<float> face_weights_;      // [faces] area times instances; 0: counts for nothing
    std::vector<std::uint32_t> mark_face_; // [vertices] a face on the marked edge
    std::uint32_t stamp_ = 0;
    std::vector<std::uint32_t> local_of_vertex_; // [complex vertices], kNone outside load
    std::vector<std::uint32_t> local_of_wedge_;  // [complex wedges]
    // The collapse at hand.
    std::span<RingFace> ring_a_;        // faces around a without b
    std::span<RingFace> ring_b_;        // faces around b without a
    std::vector<RingFace> ring_memory_; // of both, never shrinks
    std::vector<RingBlock> blocks_;     // of both rings
    std::vector<std::uint32_t> dying_;  // faces with both

    struct MergedWedges {
        std::uint32_t of_a = 0; // that meet in a face on the edge
        std::uint32_t of_b = 0;
        std::uint32_t from = 0; // what they have become by then
        std::uint32_t into = 0;
    };

    std::vector<MergedWedges> merged_wedges_; // of the collapse at hand, in order
    std::span<std::uint32_t> spokes_;         // of costSpokes()
    std::span<float> spoke_keys_;
    std::vector<std::uint32_t> spoke_memory_; // never shrinks: nothing is cleared in vain
    std::vector<float> spoke_key_memory_;
    // Wedges that meet along a spoke, {v's, the other's}, on up to two sides; kNone: none.
    using SpokePairs = std::array<std::array<std::uint32_t, 2>, 2>;
    bool releasesSeam(std::uint32_t v, std::uint32_t other, const SpokePairs& pairs) const;
    std::vector<SpokePairs> spoke_pairs_;
    std::vector<std::uint32_t> scratch_;
    CollapseLog log_;
};

inline Vector3<Float4>
ComponentMesh::positionsOf(const std::array<std::uint32_t, 4>& vertices) const {
    static_assert(sizeof(Point) == sizeof(Float4));
    const auto [x, y, z, marks] = transposed({loadFour(&points_[vertices[0]]),
                                              loadFour(&points_[vertices[1]]),
                                              loadFour(&points_[vertices[2]]),
                                              loadFour(&points_[vertices[3]])});
    return {x, y, z};
}

template <class Accept>
ComponentMesh::Spokes ComponentMesh::costSpokes(std::uint32_t v, Accept accept) {
    const std::uint32_t stamp = nextStamp();
    points_[v].mark = stamp;
    const std::span<const std::uint32_t> around = facesAround(v);
    if (spoke_memory_.size() < 3 * around.size()) {
        spoke_memory_.resize(6 * around.size());
        spoke_key_memory_.resize(6 * around.size());
    }
    std::uint32_t* const found = spoke_memory_.data();
    std::size_t count = 0;
    for (const std::uint32_t face : around)
        for (const std::uint32_t other : faces_[face]) { // no branch: half of them were seen
            const bool fresh = points_[other].mark != stamp;
            points_[other].mark = stamp;
            found[count] = other;
            count += static_cast<std::size_t>(fresh & accept(other));
        }
    spokes_ = {found, count};
    spoke_keys_ = {spoke_key_memory_.data(), count};
    if (!wedge_quadrics_.active() && wedge_counts_.empty()) {
        costSpokeEdges<SpokeWedges::None>(v);
    } else if (face_wedges_.empty()) {
        costSpokeEdges<SpokeWedges::OneEach>(v);
    } else {
        gatherSpokePairs(v);
        costSpokeEdges<SpokeWedges::Several>(v);
    }
    return {spokes_, spoke_keys_};
}

template <class Visit>
void ComponentMesh::visitReadByCollapse(Visit visit) const {
    for (const std::span<const RingFace> ring : {ring_a_, ring_b_})
        for (const RingFace& face : ring) {
            visit(face.next);
            visit(face.last);
        }
    visitChangedByCollapse(visit);
}

template <class Visit>
void ComponentMesh::visitChangedByCollapse(Visit visit) const {
    for (const std::uint32_t f : dying_)
        for (const std::uint32_t v : faces_[f])
            visit(v);
}

// Counts faces gone, over all components, and says when to stop. Looked at about every 1,000
// collapses: a few milliseconds.
struct CollapseWatch {
    const JobContext& job;
    std::atomic<std::uint64_t>& faces_gone;
    std::uint64_t faces_in_all = 0;

    // before: the mesh's live faces when last asked; brought up to date. False if to stop.
    bool goOn(const ComponentMesh& mesh, std::uint32_t& before) const {
        const std::uint64_t gone = faces_gone += before - mesh.liveFaces();
        before = mesh.liveFaces();
        constexpr double kShare = 0.9; // joining and floors take the rest
        job.report(kShare * static_cast<double>(gone) / static_cast<double>(faces_in_all));
        return !job.stopRequested();
    }
};

// Collapses until nothing is left to collapse, the cheapest edge first (indexed by a lazy heap).
// False if stopped.
bool collapseExactGreedy(ComponentMesh& mesh, const CollapseWatch& watch);

// Near-greedy passes until `stop_at_faces`: each pass takes edges by rising cost, every vertex at
// most once, up to 1.5 x the cost at which a quarter of the faces would be gone. False if stopped.
bool collapseNearGreedy(ComponentMesh& mesh,
                        std::uint32_t stop_at_faces,
                        const CollapseWatch& watch);

} // namespace lodestone
