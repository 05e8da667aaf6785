#pragma once
// The greatest distance of one surface from another. Sampling alone misses the corners and ridges
// where it is found.
#include "simplify/measure/closest_surface.h"

namespace lodestone {

// What a query near it shows to be nearer than what was reached is left out; of the rest, corners
// and middles of triangles are measured, and triangles that may hold more are split, most promising
// first, until none is left (the result is then within 0.2 % of the true maximum) or a fixed amount
// of work is done. The result is the distance of an actual point, so never above the maximum.
// known: a distance already found on `from`, in the frame; the result is not below it.
// Errors: Cancelled. Any thread; the same for any number of threads. O(triangles) queries,
// parallel. Source: branch and bound after Guthe, Borodin, Klein 2005.
Result<double> farthestDistance(std::span<const SurfacePiece> from,
                                const ClosestSurface& to,
                                double known,
                                const JobContext& job);

} // namespace lodestone
