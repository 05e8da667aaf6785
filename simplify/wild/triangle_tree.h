#pragma once
// Which triangles of other components lie near a triangle: a bounding volume hierarchy, because
// triangles of artists' models differ in size far too much for a grid.
#include "simplify/collapse/complex.h"

namespace lodestone {

class TriangleTree {
public:
    // component_of_face: [faces of the complex]. O(faces log faces).
    TriangleTree(const Complex& complex, std::span<const std::uint32_t> component_of_face);

    // Calls visit(other) for every face > `face` of another component whose box is closer than
    // `reach` to that of `face`. In an order that depends on the complex alone.
    template <class Visit>
    void visitNear(std::uint32_t face, double reach, Visit visit) const {
        const auto r = static_cast<float>(reach);
        const Box query{boxes_[face].low - r, boxes_[face].high + r};
        const std::uint32_t component = component_of_face_[face];
        std::uint32_t at = 0; // nodes in depth-first order: skipping one is a jump
        while (at < nodes_.size()) {
            const Node& node = nodes_[at];
            if (node.component == component || node.last_face <= face || apart(node.box, query)) {
                at = node.skip_to;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) // leaves only
                if (const std::uint32_t other = order_[i]; other > face &&
                                                           component_of_face_[other] != component &&
                                                           !apart(boxes_[other], query))
                    visit(other);
            ++at;
        }
    }

private:
    struct Box {
        glm::vec3 low{0.0f};
        glm::vec3 high{0.0f};
    };

    struct Node {
        Box box;
        std::uint32_t begin = 0; // of order_; empty for inner nodes
        std::uint32_t end = 0;
        std::uint32_t skip_to = 0;
        std::uint32_t component = kNone; // of all its faces, kNone: several
        std::uint32_t last_face = 0;     // the largest number
    };

    static bool apart(const Box& a, const Box& b) {
        return a.low.x > b.high.x || b.low.x > a.high.x || a.low.y > b.high.y ||
               b.low.y > a.high.y || a.low.z > b.high.z || b.low.z > a.high.z;
    }

    void build(std::uint32_t begin, std::uint32_t end);

    std::span<const std::uint32_t> component_of_face_;
    std::vector<Box> boxes_; // [faces]
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace lodestone
