#pragma once
// The faces around one vertex in order, as far as they form one disk or half a disk.
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// A place between two neighbouring faces of the fan (or at an end of an open one).
struct Spoke {
    std::uint32_t vertex = kNone;       // across
    std::uint32_t wedge_before = kNone; // there, of the face before; kNone: open end
    std::uint32_t wedge_after = kNone;  // of the face after
};

// A face seen from the vertex: vertex, then `from`, then `to`.
struct Blade {
    std::uint32_t face = 0;
    std::uint32_t which = 0; // of its corners is the vertex
    std::uint32_t from = 0;  // vertices
    std::uint32_t to = 0;
};

struct VertexFan {
    std::vector<std::uint32_t> faces; // in order, each starting at the spoke of the same number
    std::vector<Spoke> spokes;        // [faces], one more where open
    bool closed = false;
    // Spokes where a seam or a material border runs through the vertex, or the surface ends.
    std::vector<std::uint32_t> seams;
    std::vector<Blade> blades; // as `faces`
};

// star: corners at the vertex; corners: [faces] vertices. False if the faces form anything else, or
// are too many to look at. What `fan` was before is overwritten.
bool makeFan(const CloudSurface& surface,
             std::span<const Triangle> corners,
             std::span<const std::uint32_t> star,
             VertexFan& fan);

} // namespace lodestone
