#pragma once
// The outermost points of a scene, all that framing needs of it. Pure arithmetic; no GL.
#include "scene/scene.h"

#include <glm/glm.hpp>
#include <vector>

namespace lodestone {

struct FramePoints {
    std::vector<glm::dvec3> points; // world, all inside bounds; empty: nothing is drawn
    Bounds bounds;                  // of the scene, without far outliers
};

// Extremes of all instances along 200 directions: at most as many points, hull error below 2 % of
// the size. Any thread; parallel, same result on any number of threads.
// Cost: O(vertices x 64 + instances x 200), once a scene: 10 ms for 10,000 instances.
FramePoints framePoints(const Scene& scene);
// The same where bounds = robustWorldBounds(scene) are known already.
FramePoints framePoints(const Scene& scene, const Bounds& bounds);

// The corners of the box.
FramePoints framePoints(const Bounds& bounds);

} // namespace lodestone
