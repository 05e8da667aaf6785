#pragma once
// The triangles that share an atlas, and their texels.
#include "simplify/bake/atlas.h"
#include "simplify/bake/bake.h"
#include "simplify/bake/successive_map.h"
#include "simplify/bake/texture_sampler.h"

#include <memory>

namespace lodestone {

// A submesh ready to be traced back.
struct BakeSource {
    const Submesh* submesh = nullptr;
    const CollapseSequence* sequence = nullptr;
    std::unique_ptr<const SuccessiveMap> map;
    std::vector<GeometryPtr> primitives; // as read out, faces in the map's order
    double stretch = 1.0;
};

// One triangle of a group and how it is turned for flattening.
struct BakedTriangle {
    std::uint32_t submesh = 0;
    std::uint32_t primitive = 0;
    std::uint32_t face = 0;                     // of the primitive as read out
    std::array<std::uint8_t, 3> order{0, 1, 2}; // right angle, end of the base, third corner
};

// A primitive of the original whose triangles a group has taken.
struct BakedPart {
    std::uint32_t submesh = 0;
    std::uint32_t primitive = 0;
};

struct BakedGroup {
    std::size_t number = 0; // among the groups
    Material material;      // what the new one is made from
    std::vector<BakedPart> parts;
    bool normals = false;
    bool surface = false; // occlusion, roughness, metalness
    bool emission = false;
    std::vector<BakedTriangle> triangles;
    Atlas atlas;
};

// Pixels of a group's atlases; RGBA, empty where the group has none.
struct BakedPixels {
    std::vector<std::uint8_t> base_color;
    std::vector<std::uint8_t> normal;
    std::vector<std::uint8_t> surface;
    std::vector<std::uint8_t> emissive;
};

// The corner normals and tangents of a triangle once it is flattened, in the order of its corners.
struct TriangleFrame {
    std::array<glm::vec3, 3> normals;
    std::array<glm::vec4, 3> tangents;
};

// Picks the longest side as base. corners: of the triangle; order: as in BakedTriangle.
FlatTriangle flatten(const std::array<glm::vec3, 3>& corners, std::array<std::uint8_t, 3>& order);

TriangleFrame frameOf(const BakeSource& source, const BakedTriangle& triangle, bool mirrored);

// Weights of a triangle's corners at a point given by its shares of base and height.
glm::vec3 weightsOf(const BakedTriangle& triangle, double along_base, double along_height);

// A triangle whose points are looked up on the original. source outlives it. Any thread.
class TracedTriangle {
public:
    TracedTriangle(const BakeSource& source, const BakedTriangle& triangle);

    const glm::vec3& normal() const { return normal_; } // as long as twice the area

    // What the original shows where a point of the triangle came from. weights: of its corners.
    SurfaceLook lookAt(const glm::vec3& weights, const TextureSampler& sampler) const;

private:
    const BakeSource& source_;
    std::uint32_t face_;
    std::array<glm::vec3, 3> corners_;
    glm::vec3 normal_;
};

// Texture coordinates of a triangle's corners, in their order.
std::array<glm::vec2, 3> coordinatesOf(const BakedGroup& group, std::size_t triangle);

// Fills the texels of a group. done(count): called now and then from any thread with the triangles
// finished since. Errors: Cancelled.
Result<BakedPixels> bakePixels(const BakedGroup& group,
                               std::span<const BakeSource> sources,
                               const TextureSampler& sampler,
                               const BakeOptions& options,
                               const std::function<bool(std::size_t)>& done);

} // namespace lodestone
