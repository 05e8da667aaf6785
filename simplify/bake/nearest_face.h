#pragma once
// The original triangle nearest to a point of a simplified surface, on the side that the point is
// seen from, by a bounding volume hierarchy.
#include "simplify/collapse/complex.h"

#include <array>

namespace lodestone {

// Immutable once made; queries from any number of threads at once.
class NearestFace {
public:
    // corners: [wedges] positions of the complex's wedges. Both may go afterwards.
    // O(faces log faces).
    NearestFace(const Complex& complex, std::span<const glm::vec3> corners);

    struct Query {
        glm::vec3 point{0.0f};
        glm::vec3 normal{0.0f}; // any length; faces that look the other way do not count
        std::uint32_t near = 0; // a face thought to be near: the answer unless another is nearer
    };

    // Faces of other components than that of query.near count as twice as far. The same answer for
    // the same query. About O(log faces).
    std::uint32_t closest(const Query& query) const;

private:
    struct Node {
        glm::vec3 low{0.0f};
        std::uint32_t begin = 0; // of order_
        glm::vec3 high{0.0f};
        std::uint32_t end = 0;
        std::uint32_t right = 0; // the left child is the next node; 0: a leaf

        float squaredDistance(const glm::vec3& point) const;
    };

    std::uint32_t build(std::uint32_t begin, std::uint32_t end);
    Node boundsOf(std::uint32_t begin, std::uint32_t end) const;

    std::vector<std::array<glm::vec3, 3>> triangles_; // [faces]
    std::vector<std::uint32_t> component_;            // [faces]
    std::vector<std::uint32_t> order_;                // faces, by node
    std::vector<Node> nodes_;                         // depth first
};

} // namespace lodestone
