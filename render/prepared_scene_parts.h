#pragma once
// Inside render/ only: what prepareScene() made.
#include "render/gpu_geometry.h"
#include "render/gpu_texture.h"
#include "render/prepared_scene.h"
#include "scene/pose.h"

namespace lodestone {

enum class Mirroring : std::uint8_t { None, All, Mixed };

struct GpuSubmesh {
    LocalFrame frame;
    Bounds box; // local, of all vertices
    InstanceRange range;
    Mirroring mirroring = Mirroring::None;
    glm::vec4 id_color{1.0f}; // linear
};

struct PreparedScene {
    ScenePtr scene;
    Bounds bounds; // robust
    SceneFrame frame;
    std::vector<GpuSubmesh> submeshes; // [scene.submeshes]
    std::vector<TextureWish> wishes;   // unique
    std::vector<DecodedImage> images;  // [wishes]
    RigPtr rig;                        // never null
    Pose rest;
};

} // namespace lodestone
