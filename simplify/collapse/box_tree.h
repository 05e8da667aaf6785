#pragma once
// The nearest of a submesh's triangles, for any instance of it: one tree serves them all.
#include "simplify/collapse/box.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace lodestone {

class BoxTree {
public:
    using Corners = std::array<glm::vec3, 3>;

    // Where an instance puts the triangles.
    struct Placement {
        Placement(const glm::mat3& linear, const glm::vec3& offset);

        glm::mat3 linear;
        glm::vec3 offset;
        glm::mat3 inverse;    // of linear, 0 if that is flat
        float least_stretch2; // linear makes nothing shorter than by its root; 0 if it is flat
    };

    // O(n log n).
    explicit BoxTree(std::span<const Corners> triangles);

    // Squared distance of a point from the nearest triangle, if that is less than `limit`, else
    // `limit`.
    float nearest(const glm::vec3& point, const Placement& placement, float limit) const;

private:
    // Around triangles; an inner node's first child follows it.
    struct Node {
        Box box;
        std::uint32_t begin = 0; // of a leaf's triangles_
        std::uint32_t end = 0;
        std::uint32_t second = 0; // child; 0: a leaf
    };

    struct Middle {
        glm::vec3 at{0.0f};
        std::uint32_t triangle = 0;
    };

    Box build(std::span<const Corners> triangles, std::span<Middle> middles);

    std::vector<Corners> triangles_; // leaf by leaf
    std::vector<Node> nodes_;
};

} // namespace lodestone
