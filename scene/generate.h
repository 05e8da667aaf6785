#pragma once
#include "scene/result.h"
#include "scene/scene.h"

namespace lodestone {

// Names of the built-in sample scenes: "bunny", "chair", "maple", "village".
std::span<const std::string_view> sampleNames();

// Makes a sample scene. Same name and seed, same scene on any machine.
// Counts (submeshes / instances / triangles) are those of Azim et al. 2015, Table 1, exactly:
// chair 6/68/2,240, maple 18/9,324/1,818,074 (<= 90,000 unique), village 79/13,523/1,254,696
// (<= 100,000 unique); bunny 1/1/69,000..70,000, closed. Errors: Usage for an unknown name.
Result<ScenePtr> generateScene(std::string_view name, std::uint64_t seed = 1);

} // namespace lodestone
