#pragma once
// The six methods as pure functions: one pass over a surface to what merges, or to what is removed.
// Distances are in the surface's units, angles in degrees. All are sequential, deterministic and
// near-linear in the faces. They stop early where asked to: the caller looks at the job and drops
// what it got. Source: the six point-cloud methods (VT, FAD, IVDD, SS, VTD, FASS).
#include "scene/job_context.h"
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// VT: in triangle order, each triangle none of whose vertices was merged in this pass becomes one
// vertex, at the centre of its smallest enclosing circle (Literal: its circumcentre).
// share: part of the triangles that are looked at, 0..1, spread evenly over the order.
Merges
vertexTriplex(const CloudSurface& surface, double share, Fidelity fidelity, const JobContext& job);

} // namespace lodestone
