#pragma once
// The simplicial complex that a submesh is collapsed on: topology on welded positions, attributes
// on wedges (a wedge is a vertex of the file; several may share a position along a seam).
#include "scene/job_context.h"
#include "scene/scene.h"
#include "simplify/collapse/bulk.h"

#include <array>

namespace lodestone {

struct Complex {
    // Wedges of all triangle primitives, in the file's order; equal ones of a primitive are one.
    std::vector<std::uint32_t> wedge_source;         // [wedges] vertex in its primitive's geometry
    std::vector<std::uint32_t> wedge_vertex;         // [wedges] welded vertex
    std::vector<glm::vec3> positions;                // [vertices]
    Bulk bulk;                                       // of positions
    std::vector<std::array<std::uint32_t, 3>> faces; // [faces] wedges; none degenerate
    std::vector<std::uint32_t> wedge_begin;          // [primitives + 1]
    std::vector<std::uint32_t> face_begin;           // [primitives + 1]
    // Connected components (sharing a welded vertex), by rising first face; faces in order.
    std::vector<std::uint32_t> component_begin; // [components + 1] into component_faces
    std::vector<std::uint32_t> component_faces; // [faces]
    // Pairs of vertices that may collapse though no face joins them: both ends in one component,
    // by component. Empty: none.
    std::vector<std::array<std::uint32_t, 2>> virtual_edges;
    std::vector<std::uint32_t> virtual_begin; // [components + 1] or empty
    std::uint32_t dropped_faces = 0;          // degenerate after welding, or exact doubles

    std::size_t componentCount() const { return component_begin.size() - 1; }

    std::size_t primitiveOfFace(std::uint32_t face) const;
};

// Builds the complex of a submesh's triangle primitives (others get empty ranges).
// Positions weld where they are bitwise equal (-0 = 0) inside a weld block. O(vertices + faces).
// Stops early where asked to: the caller looks at the job and drops what it got.
Complex buildComplex(const Submesh& submesh, const JobContext& job);

} // namespace lodestone
