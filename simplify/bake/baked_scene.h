#pragma once
#include "scene/scene.h"

namespace lodestone {

// A LOD with textures of its own.
struct BakedScene {
    ScenePtr scene;
    double texels_per_unit = 0.0;   // of world length, the least of all atlases; 0: no atlas
    std::vector<std::string> notes; // textures that could not be read, parts that were left out
};

} // namespace lodestone
