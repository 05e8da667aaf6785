#pragma once
// Inside render/ only: the pose that a scene is drawn in, as the GPU takes it.
#include "render/gpu_geometry.h"
#include "render/prepared_scene_parts.h"
#include "scene/pose.h"

namespace lodestone {

struct SubmeshPose {
    bool posed = false;         // transforms come from the pose's texels, not from instance rows
    bool morphed = false;       // some weight is not 0
    std::int32_t first_row = 0; // texel of an instance: first_row + its index in Scene::instances
    Mirroring mirroring = Mirroring::None; // of posed ones
};

// Texels of four floats. One for each instance of a submesh that is posed or morphed: first texel
// of its matrices (three rows each, scene from local), index of the last one (> 0: joints), first
// texel of its morph weights (four a texel). Then matrices and weights.
struct PackedPose {
    std::vector<glm::vec4> texels;      // empty: nothing moves
    std::vector<SubmeshPose> submeshes; // [scene.submeshes]
    std::vector<glm::dmat4> transforms; // [scene.instances]; empty: the scene's
    Bounds reach;                       // world, encloses what is posed
};

// What packing a pose needs of its scene.
struct PoseSource {
    const Scene& scene;
    const Rig& rig;
    const Pose& rest;
    std::span<const GpuSubmesh> submeshes;
    SceneFrame frame;
};

// Any thread; no GL. O(instances of moving submeshes + joints).
PackedPose packPose(const PoseSource& source, const Moment& moment);

} // namespace lodestone
