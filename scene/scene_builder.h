#pragma once
// Builds a Scene that did not come from glTF, and the glTF document that an export of it needs.
#include "scene/scene.h"

#include <glm/gtc/quaternion.hpp>

namespace lodestone {

// A node's own transform as glTF prefers to have it: first scale, then rotate, then move.
struct Trs {
    glm::dvec3 translation{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 scale{1.0};
};

glm::dmat4 toMatrix(const Trs& trs);

// Splits an affine matrix into a TRS. False if translation, rotation (unit) and scale (one of them
// negative for a mirror) cannot express it within 1e-6 of its largest column: shear, perspective,
// a column of length zero.
bool decompose(const glm::dmat4& matrix, Trs& out);

// Collects parts in any order that keeps indices known (parents before children), then makes the
// Scene. Indices returned are those of the Scene's lists. Not thread-safe; one scene per builder.
class SceneBuilder {
public:
    explicit SceneBuilder(std::string name);
    ~SceneBuilder();
    SceneBuilder(const SceneBuilder&) = delete;
    SceneBuilder& operator=(const SceneBuilder&) = delete;

    std::uint32_t addImage(Image image);          // bytes are embedded by an export
    std::uint32_t addMaterial(Material material); // its textures and samplers are made here
    std::uint32_t addSubmesh(Submesh submesh);

    // local: relative to the parent; written as TRS where decompose() can, else as a matrix.
    std::uint32_t addNode(std::string name,
                          std::uint32_t parent = kNone,
                          const glm::dmat4& local = glm::dmat4(1.0),
                          std::uint32_t submesh = kNone);
    // The exact numbers of the TRS go into the document.
    std::uint32_t
    addNode(std::string name, std::uint32_t parent, const Trs& local, std::uint32_t submesh);

    // camera.world is overwritten by the node's world transform. At most one camera a node.
    std::uint32_t addCamera(Camera camera, std::uint32_t node);

    void addNote(std::string note);
    void setFileBytes(std::uint64_t bytes);

    // Takes a node out of what an export may fold into GPU instances (it is a leaf with a meaning
    // of its own). Nodes with children or a camera are never folded.
    void keepNode(std::uint32_t node);

    // The document under construction, for what no call above covers (skins, animations, extras,
    // a material's own words). Nodes, meshes, materials and images are already in it, in order.
    SourceDocument& document();
    // Flags and indices of a node under construction (skin, animated).
    Node& node(std::uint32_t index);

    // Computes world transforms, instances (sorted by submesh, then by node) and foldable flags.
    // The builder is empty afterwards. A node whose submesh has no primitive draws nothing.
    ScenePtr finish();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace lodestone
