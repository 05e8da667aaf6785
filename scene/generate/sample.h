#pragma once
// The sample scenes and what they are put together from.
#include "scene/generate/mesh_maker.h"
#include "scene/scene_builder.h"

#include <string_view>

namespace lodestone::generate {

ScenePtr makeBunny(std::uint64_t seed);
ScenePtr makeChair(std::uint64_t seed);
ScenePtr makeMaple(std::uint64_t seed);
ScenePtr makeVillage(std::uint64_t seed);

// How a material looks: colour as an artist picks it (sRGB, 0xRRGGBB), converted to linear.
struct Look {
    std::uint32_t srgb = 0xFFFFFF;
    double roughness = 0.9;
    bool double_sided = false;
};

// Rotation whose y axis is `up`, with its z axis as near to `forward` as it can be. Neither zero.
glm::dquat upright(const glm::dvec3& up, const glm::dvec3& forward);
glm::dquat yaw(double angle);

// A SceneBuilder that counts, for scenes whose last submesh makes up the exact numbers.
class Sample {
public:
    explicit Sample(std::string name) : builder_(std::move(name)) {}

    // One submesh with a material of its own.
    std::uint32_t
    add(const std::string& name, const Mesh& mesh, double crease_angle, const Look& look);
    std::uint32_t addGroup(const std::string& name); // a node to hold others
    void place(std::uint32_t submesh, const Trs& trs, std::uint32_t group);

    std::size_t instanceCount() const { return instance_count_; }

    std::size_t triangleCount() const { return triangle_count_; } // instanced

    std::size_t triangleCount(std::uint32_t submesh) const { return triangles_[submesh]; }

    ScenePtr finish() { return builder_.finish(); }

private:
    SceneBuilder builder_;
    std::vector<std::string> names_;     // [submeshes]
    std::vector<std::size_t> triangles_; // [submeshes]
    std::vector<std::size_t> placed_;    // [submeshes]
    std::size_t instance_count_ = 0;
    std::size_t triangle_count_ = 0;
};

} // namespace lodestone::generate
