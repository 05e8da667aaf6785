#pragma once
// How long the six point-cloud methods take to follow a slider.
#include "scene/result.h"
#include "scene/scene.h"

#include <iosfwd>

namespace lodestone::bench {

// Writes a Markdown table of the six methods on a scene: what each step of a slider costs in wall
// time and in CPU time of all threads, once the lane is there. Two sliders: the main parameter, at
// twelve values, each the method run anew; and the target, from 90 to 5 % of the triangles, each a
// search for the parameter. Errors: those of the methods. Any thread.
Result<void> writeLiveSliders(std::ostream& out, const ScenePtr& scene);

} // namespace lodestone::bench
