#pragma once
// What moves in a scene: node transforms, skins and animations of its file, read once from
// Scene::source. Plain values.
#include "scene/scene.h"
#include "scene/scene_builder.h"

#include <memory>
#include <optional>

namespace lodestone {

enum class AnimatedPath : std::uint8_t { Translation, Rotation, Scale, Weights };
enum class Interpolation : std::uint8_t { Step, Linear, CubicSpline };

// One animated property of one node.
struct AnimationChannel {
    std::uint32_t node = 0; // in Rig::nodes
    AnimatedPath path = AnimatedPath::Translation;
    Interpolation interpolation = Interpolation::Linear;
    std::uint32_t components = 3; // 3; rotation 4 (x y z w); weights: morph targets
    std::vector<float> times_s;   // rising, finite, not empty
    // [times * components], finite; CubicSpline: [times * 3 * components], of each key the tangent
    // into it, the value, the tangent out of it.
    std::vector<float> values;
};

struct SceneAnimation {
    std::string name; // may be empty
    double duration_s = 0.0;
    std::vector<AnimationChannel> channels;
};

struct RigNode {
    std::uint32_t parent = kNone;
    std::optional<glm::dmat4> matrix; // instead of trs
    Trs trs;
    std::vector<float> weights; // of morph targets; as many as any primitive has
    std::uint32_t skin = kNone;
    bool draws_in_skin = false; // it has a mesh and a skin
};

struct Skin {
    std::vector<std::uint32_t> joints;     // in Rig::nodes
    std::vector<glm::dmat4> inverse_binds; // [joints]
};

struct Rig {
    std::vector<RigNode> nodes;       // as in the document
    std::vector<std::uint32_t> order; // parents before children; what hangs in a cycle is absent
    std::vector<std::uint32_t> node_of_scene_node; // [scene.nodes]
    std::vector<Skin> skins;
    std::vector<SceneAnimation> animations;
    std::vector<std::string> notes; // what could not be read and stays at rest
};

using RigPtr = std::shared_ptr<const Rig>;

// Never fails: a channel or skin that cannot be read is left out and named in Rig::notes. A scene
// without a document has an empty rig. Any thread; O(nodes + bytes of the animations).
RigPtr readRig(const Scene& scene);

} // namespace lodestone
