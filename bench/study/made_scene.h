#pragma once
// Made scenes of the study: as many as wanted, no two alike, the same on every machine.
#include "scene/scene.h"

#include <array>

namespace lodestone::bench {

enum class SceneKind : std::uint8_t {
    Object,    // parts of one thing, side by side
    Furniture, // bars and turned legs in rows, some mirrored
    Facade,    // boxes and panels in a grid, each scaled along its axes
    Machine,   // turned parts and bolts in rings
    Forest,    // leaves about crowns of trees, turned any way, 1 : 4 in size
    City,      // things of sizes from 1 to 1000 under nested nodes, some sheared
};

inline constexpr std::array kSceneKinds{SceneKind::Object,
                                        SceneKind::Furniture,
                                        SceneKind::Facade,
                                        SceneKind::Machine,
                                        SceneKind::Forest,
                                        SceneKind::City};

const char* kindName(SceneKind kind); // "object"

struct SceneRecipe {
    SceneKind kind = SceneKind::Object;
    std::uint64_t seed = 1;
    std::uint32_t submeshes = 1;   // >= 1
    std::uint32_t instances = 1;   // >= submeshes
    std::uint32_t part_faces = 12; // of a submesh, about; >= 2
};

// Instances are shared out unevenly, every submesh has at least one.
ScenePtr makeScene(const SceneRecipe& recipe);

} // namespace lodestone::bench
