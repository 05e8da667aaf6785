#pragma once
// What the six point-cloud methods work on and give back: a submesh's triangles in the middle of a
// simplification. Topology on welded vertices, attributes on wedges.
#include "simplify/collapse/complex.h"

namespace lodestone {

using Triangle = std::array<std::uint32_t, 3>;
using Triangle3d = std::array<glm::dvec3, 3>;

struct CloudSurface {
    std::vector<glm::dvec3> positions;       // [vertices] where each vertex is now
    std::vector<std::uint32_t> wedge_vertex; // [wedges]; kNone: no face has it any more
    // [wedges] equal for wedges of a vertex that differ in their normals and tangents at most
    std::vector<std::uint32_t> chart;
    std::vector<std::uint32_t> stands_for; // [vertices] of the input; kNone: removed
    std::vector<Triangle> faces;           // [faces] wedges; no two corners at one vertex
    std::vector<std::uint32_t> primitive;  // [faces] of the submesh
    std::vector<std::uint8_t> two_sided;   // [faces] the input has the same face turned over
    std::vector<std::uint8_t> changed;     // [faces] not as in the input
    bool from_points = false;              // faces rebuilt from the points alone
    double removal_error = 0.0;            // how far a removed vertex lies from what replaced it

    Triangle corners(std::size_t face) const {
        const Triangle& wedges = faces[face];
        return {wedge_vertex[wedges[0]], wedge_vertex[wedges[1]], wedge_vertex[wedges[2]]};
    }

    Triangle3d points(std::size_t face) const {
        const Triangle vertices = corners(face);
        return {positions[vertices[0]], positions[vertices[1]], positions[vertices[2]]};
    }
};

// The surface of a submesh before any simplification. O(faces). Empty where asked to stop.
CloudSurface makeSurface(const Submesh& submesh, const Complex& complex, const JobContext& job);

// Compacts the lists of faces to those that keep(face) wants.
template <class Keep>
void keepFaces(CloudSurface& surface, Keep keep) {
    std::size_t kept = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        if (!keep(f))
            continue;
        surface.faces[kept] = surface.faces[f];
        surface.primitive[kept] = surface.primitive[f];
        surface.two_sided[kept] = surface.two_sided[f];
        surface.changed[kept] = surface.changed[f];
        ++kept;
    }
    surface.faces.resize(kept);
    surface.primitive.resize(kept);
    surface.two_sided.resize(kept);
    surface.changed.resize(kept);
}

// Wedges without a face lose their vertex.
void forgetUnusedWedges(CloudSurface& surface);

// Twice the area of a triangle along its normal.
glm::dvec3 faceVector(const Triangle3d& points);

// The corners at each vertex, by rising face. A corner is 3 * face + which.
struct Stars {
    std::vector<std::uint32_t> begin;   // [vertices + 1] into corners
    std::vector<std::uint32_t> corners; // [3 * faces]

    std::span<const std::uint32_t> of(std::uint32_t vertex) const {
        return {corners.data() + begin[vertex], corners.data() + begin[vertex + 1]};
    }
};

// faces: corners at vertices below vertex_count. O(faces + vertices). Empty where asked to stop.
Stars buildStars(std::span<const Triangle> faces, std::size_t vertex_count, const JobContext& job);

// What a method decided: which vertices become one, and where it lies.
struct Merges {
    std::vector<std::uint32_t> target; // [vertices] target[target[v]] == target[v]
    std::vector<glm::dvec3> positions; // [vertices] finite; of targets
};

// True once every thousand rounds if the job is to stop.
inline bool stopsAt(std::size_t round, const JobContext& job) {
    constexpr std::size_t kCheckEvery = 1'024;
    return round % kCheckEvery == 0 && job.stopRequested();
}

} // namespace lodestone
