#pragma once
// The six methods as pure functions: one pass over a surface to what merges, or to what is removed.
// Distances are in the surface's units, angles in degrees. All are sequential, deterministic and
// near-linear in the faces. They stop early where asked to: the caller looks at the job and drops
// what it got, which may be empty. Source: the six point-cloud methods (VT, FAD, IVDD, SS, VTD,
// FASS).
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// As the paper words it, or with what keeps the surface sound: smallest enclosing circles instead
// of circumcentres, and no merge that turns a face over (SS: none where another place helps).
enum class Fidelity : std::uint8_t { Sound, Literal };

// VT: in triangle order, each triangle none of whose vertices was merged in this pass becomes one
// vertex, at the centre of its circle.
// share: part of the triangles that are looked at, 0..1, spread evenly over the order.
Merges
vertexTriplex(const CloudSurface& surface, double share, Fidelity fidelity, const JobContext& job);

// IVDD: in triangle order, if a vertex is nearer than `distance` to both others all three become
// the centre of their circle, else the ends of an edge shorter than that become its midpoint.
// Merged vertices carry their new place in everything later. Sound: after the same walks with
// smaller thresholds, halves of halves.
Merges intervertexDistance(const CloudSurface& surface,
                           double distance,
                           Fidelity fidelity,
                           const JobContext& job);

// SS: a sphere visits the vertices in order; all unmerged ones inside become one, at the best by
// quadric error of their centroid, the vertex nearest to that, and the quadric's optimum.
Merges sphericalScanning(const CloudSurface& surface,
                         double radius,
                         Fidelity fidelity,
                         const JobContext& job);

// VTD: in triangle order, three edges all below `distance` become the centre of their circle;
// beside one edge within it, the longer of the other two becomes its midpoint (Sound: the short one
// if that is more than twice as long as `distance`, and walks as in IVDD).
Merges vertexTriplexDistance(const CloudSurface& surface,
                             double distance,
                             Fidelity fidelity,
                             const JobContext& job);

struct FaceAngleOptions {
    double angle_deg = 30.0;  // between any two faces around a removable vertex, at most
    double area_share = 1.0;  // of the surface's area: what they may cover, at most
    std::uint32_t passes = 1; // in one pass no two adjacent vertices are removed
    // Literal: what is removable is decided once, on the surface as it comes.
    Fidelity fidelity = Fidelity::Sound;
};

// FAD: removes vertices in flat neighbourhoods and triangulates the holes in their best-fit plane.
// Kept: vertices on a border or seam that is not nearly straight there, those whose hole does not
// project simply, and those without which an edge would get a third face.
void removeFlatVertices(CloudSurface& surface,
                        const FaceAngleOptions& options,
                        const JobContext& job);

} // namespace lodestone
