#pragma once
// The collapses of one submesh in order, readable at any step in both directions: a progressive
// mesh (Hoppe 1996) stored by lifetimes. Step 0 is the submesh as the file has it.
#include "scene/job_context.h"
#include "scene/result.h"
#include "simplify/collapse/component_mesh.h"
#include "simplify/collapse/crowd_growth.h"
#include "simplify/collapse/extremes.h"

namespace lodestone {

struct CollapseSequence {
    // --- steps; index s - 1 for step s
    std::vector<double> cost; // quadric error times instance weights, world length^4
    std::vector<float> error; // estimated distance in the submesh's units
    // Steps allowed by the floors; the rest is recorded but not scheduled.
    std::uint32_t step_count = 0;

    // --- faces and wedges alive
    Complex complex;                         // faces, wedges and positions at the start
    std::vector<std::uint32_t> face_death;   // [faces] alive at s iff face_death > s
    std::vector<std::uint32_t> wedge_death;  // [wedges] the same
    std::vector<std::uint32_t> wedge_parent; // [wedges] what it became; kNone: no face left
    std::vector<std::uint32_t> kill_order;   // dead wedges, by component, then by rising step
    std::vector<std::uint32_t> kill_begin;   // [components + 1] into kill_order

    struct PrimitiveCounts {
        std::vector<std::uint32_t> faces;  // [steps + 1] alive at a step (0: after cleaning)
        std::vector<std::uint32_t> wedges; // [steps + 1]
    };

    std::vector<PrimitiveCounts> counts; // [primitives]

    // --- where wedges lie; versions of a wedge by rising step
    std::vector<std::uint32_t> version_begin;   // [wedges + 1]
    std::vector<std::uint32_t> version_step;    // [versions]
    std::vector<glm::vec3> version_position;    // [versions]
    std::vector<std::uint32_t> version_carrier; // [versions] or empty
    std::vector<float> version_values;          // [versions * attributes.size]
    WedgeAttributes attributes;                 // layout; values are dropped after building
    CrowdGrowth crowds;                         // read-outs alone grow what is left of them

    std::uint32_t recordedSteps() const { return static_cast<std::uint32_t>(cost.size()); }

    // Triangles at a step; the submesh's own count at step 0.
    std::uint32_t facesAt(std::uint32_t step) const;
};

// Floors: a submesh never disappears by collapsing.
struct FloorOptions {
    bool enabled = true;
    std::uint32_t min_triangles = 4; // or all it has, if fewer
    // Share of every axis but a thin one, and 5/8 of it of the area, while it is a crowd. High
    // floors make instances go, and what is left grow, before shapes are used up, which costs more
    // in distance and in the picture than coarse shapes do; low ones make lamps spikes.
    double min_shape = 0.5;
    // Instances that make a crowd, of which some can go while others grow. Of fewer each is missed
    // more than its shape: they are collapsed on.
    std::uint32_t min_crowd = 16;
};

struct SequenceRequest {
    const Submesh* submesh = nullptr;
    InstanceWeights weights;
    std::uint32_t instance_count = 1;
    double world_weight = 1.0;     // x costs (1 for the submesh's own units)
    std::vector<Posture> postures; // in which it should keep its box
};

// Builds the sequences of several submeshes, parallel over them and over their components.
// Result [requests]. Same input, same result, any number of threads. Errors: Cancelled.
// O(V log V). Any thread.
Result<std::vector<CollapseSequence>> buildSequences(std::span<const SequenceRequest> requests,
                                                     const CollapseOptions& options,
                                                     const FloorOptions& floors,
                                                     const JobContext& job);

// Joins the logs of a submesh's components into one sequence, cheapest step first (ties:
// component). cost_scales [components]: x logged costs; length_scales [components]: x logged
// distances.
CollapseSequence joinLogs(Complex complex,
                          WedgeAttributes attributes,
                          std::vector<CollapseLog> logs,
                          std::span<const double> cost_scales,
                          std::span<const double> length_scales);

// The last step that the floors allow.
std::uint32_t floorStep(const CollapseSequence& sequence,
                        const Submesh& submesh,
                        std::uint32_t instance_count,
                        const FloorOptions& floors);

// Geometry of a submesh at a step >= 1, [primitives]; primitives that are no triangle lists are the
// submesh's own. Vertices are scaled by `scale` about `pivot`. Parallel where large.
// O(faces + wedges). Any thread.
std::vector<GeometryPtr> readOutSubmesh(const CollapseSequence& sequence,
                                        const Submesh& submesh,
                                        std::uint32_t step,
                                        double scale,
                                        const glm::dvec3& pivot);

// Position of a wedge that is alive at a step.
glm::vec3 wedgePosition(const CollapseSequence& sequence,
                        const Submesh& submesh,
                        std::uint32_t wedge,
                        std::uint32_t step);

// For every wedge the one that stands for it at a step (itself if alive). out: [wedges]
void resolveWedges(const CollapseSequence& sequence,
                   std::uint32_t step,
                   std::span<std::uint32_t> out);

} // namespace lodestone
