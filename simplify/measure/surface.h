#pragma once
// A LOD's triangles as an instanced surface in a frame where float precision is spent well. Shared
// by the sampler and the closest-point structure.
#include "simplify/measure/distance.h"
#include "simplify/measure/triangle.h"

namespace lodestone {

// Measuring happens in (world - origin) * scale: the reference scene's diagonal becomes 1.
struct SurfaceFrame {
    glm::dvec3 origin{0.0};
    double scale = 1.0; // > 0
};

// Frame of a scene's robust world bounds. Errors: BadInput if the scene has no extent.
Result<SurfaceFrame> frameOf(const Scene& scene);

// Farther out than this (in diagonals, per axis) float cannot hold the rest of the scene: triangles
// that reach beyond are neither sampled nor hit.
constexpr double kFarLimit = 1e6;

// One primitive of one kept instance.
struct SurfacePiece {
    const Geometry* geometry = nullptr; // at least one triangle
    glm::dmat4 to_frame{1.0};           // local to frame
    std::uint32_t submesh = 0;
    std::uint32_t primitive = 0; // of the submesh
    std::uint32_t material = kNone;

    glm::dvec3 corner(std::uint32_t vertex) const;
    Triangle triangle(std::size_t index) const; // in the frame
};

// Every triangle primitive of every kept instance, by submesh, instance, primitive. Borrows the
// geometries of the view. O(kept instances).
std::vector<SurfacePiece> surfacePieces(const LodView& view, const SurfaceFrame& frame);

bool isFar(const glm::dvec3& point);     // beyond kFarLimit
bool isFar(const Triangle& triangle);    // any corner
double areaOf(const Triangle& triangle); // 0 for far triangles: they are not part of the surface

} // namespace lodestone
