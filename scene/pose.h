#pragma once
// The scene at a moment of one of its animations. Pure functions; any thread.
#include "scene/lod.h"
#include "scene/rig.h"

namespace lodestone {

struct Moment {
    std::uint32_t animation = kNone; // in Rig::animations; kNone, or out of range: at rest
    double time_s = 0.0;             // before the first key and after the last one those hold

    bool operator==(const Moment&) const = default;
};

struct Pose {
    std::vector<glm::dmat4> worlds;          // [rig.nodes]
    std::vector<std::vector<float>> weights; // [rig.nodes] of morph targets
};

// Keys are interpolated as glTF 2.0 has it: STEP, LINEAR (rotations along the shorter arc),
// CUBICSPLINE. O(nodes + channels * log keys).
Pose poseAt(const Rig& rig, const Moment& moment);

// World from skin space of each joint. skin in range. [joints]
std::vector<glm::dmat4> jointMatrices(const Rig& rig, const Pose& pose, std::uint32_t skin);

// How one instance is drawn in a pose.
struct InstancePose {
    glm::dmat4 transform{1.0};      // of an instance without skin
    std::uint32_t skin = kNone;     // then its vertices go with the joints alone
    std::span<const float> weights; // into the pose; of morph targets
    bool moved = false;             // transform is not the scene's
};

// rest: poseAt(rig, {}). instance in range. An instance whose node does not move keeps the scene's
// transform to the bit.
InstancePose instancePose(
    const Scene& scene, const Rig& rig, const Pose& rest, const Pose& pose, std::uint32_t instance);

// World positions of a geometry's vertices: morphed, then skinned or placed.
// joints: jointMatrices() of the instance's skin, empty without. [positions]
std::vector<glm::dvec3> posedPositions(const Geometry& geometry,
                                       const InstancePose& instance,
                                       std::span<const glm::dmat4> joints);

// World bounds of what a LOD of the scene draws; vertices no triangle, line or point uses do not
// count. O(instanced vertices).
Bounds posedBounds(const Scene& scene, const Lod& lod, const Rig& rig, const Moment& moment);

} // namespace lodestone
