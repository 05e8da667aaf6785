#pragma once
#include "scene/scene.h"

namespace lodestone {

// The triangles that share an atlas, and how fine their texels are.
struct BakedAtlas {
    std::uint32_t material = kNone;       // of the new scene
    std::uint32_t original_image = kNone; // the first base colour texture it was made from
    double texels_per_unit = 0.0;         // of world length, the same on all of its triangles
    // Mean over the area of what it was made from; 0: nothing there had a base colour texture.
    double original_texels_per_unit = 0.0;
};

// A LOD with textures of its own.
struct BakedScene {
    ScenePtr scene;
    std::vector<BakedAtlas> atlases;
    double texels_per_unit = 0.0;   // of world length, the least of all atlases; 0: no atlas
    std::vector<std::string> notes; // textures that could not be read, parts that were left out
};

} // namespace lodestone
