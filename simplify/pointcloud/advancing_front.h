#pragma once
// The "point cloud" retriangulation: connectivity thrown away and rebuilt from the points alone.
#include "simplify/pointcloud/cloud_surface.h"

namespace lodestone {

// Replaces the faces by those of an advancing front over the 3D Delaunay triangulation of the
// vertices, turned like the old ones around them. Gaps of up to 24 edges that the front leaves in
// what was closed are filled. Left as it is where that gives nothing, more
// faces than before, or fails. Not interruptible once started. O(vertices log vertices).
// Source: Cohen-Steiner and Da 2004, by CGAL.
// A build without CGAL leaves every surface as it is and does not offer the choice.
void rebuildFromPoints(CloudSurface& surface);
bool canRebuildFromPoints();

} // namespace lodestone
