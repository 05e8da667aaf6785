#pragma once
#include "scene/scene.h"

namespace lodestone {

// Adds a note for vertices that lie finitely but absurdly far from the rest (as robustWorldBounds
// tells them), naming the first. O(instanced vertices).
void noteOutliers(Scene& scene);

} // namespace lodestone
