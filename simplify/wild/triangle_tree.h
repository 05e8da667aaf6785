#pragma once
// Which triangles of other components lie near a triangle: a bounding volume hierarchy, because
// triangles of artists' models differ in size far too much for a grid.
#include "simplify/collapse/box.h"
#include "simplify/collapse/complex.h"

#include <algorithm>

namespace lodestone {

class TriangleTree {
public:
    // component_of_face: [faces of the complex]. O(faces log faces).
    TriangleTree(const Complex& complex, std::span<const std::uint32_t> component_of_face);

    std::size_t leafCount() const { return leaves_.size(); }

    // Calls visit(face, other), face < other, for the pairs of faces of different components whose
    // boxes are closer than `reach`, one of them in a leaf and the other in it or in a later one:
    // over all leaves every pair comes up once. In an order that depends on the complex alone.
    template <class Visit>
    void visitPairs(std::size_t leaf, double reach, Visit visit) const {
        const auto r = static_cast<float>(reach);
        const Node& home = nodes_[leaves_[leaf]];
        const Box query{home.box.low - r, home.box.high + r};
        for (std::uint32_t at = leaves_[leaf]; at < nodes_.size();) {
            const Node& node = nodes_[at]; // depth first: skipping one is a jump
            if (apart(node.box, query) ||
                (node.component == home.component && node.component != kNone)) {
                at = node.skip_to;
                continue;
            }
            for (std::uint32_t i = home.begin; i < home.end && node.begin < node.end; ++i) {
                const std::uint32_t face = order_[i];
                const Box around{boxes_[face].low - r, boxes_[face].high + r};
                if (apart(node.box, around))
                    continue;
                for (std::uint32_t j = std::max(node.begin, i + 1); j < node.end; ++j)
                    if (const std::uint32_t other = order_[j];
                        !apart(boxes_[other], around) &&
                        component_of_face_[face] != component_of_face_[other])
                        visit(std::min(face, other), std::max(face, other));
            }
            ++at;
        }
    }

private:
    struct Node {
        Box box;
        std::uint32_t begin = 0; // of order_; empty for inner nodes
        std::uint32_t end = 0;
        std::uint32_t skip_to = 0;
        std::uint32_t component = kNone; // of all its faces, kNone: several
    };

    static bool apart(const Box& a, const Box& b) {
        // No branch: which of them parts two boxes cannot be foreseen.
        return (a.low.x > b.high.x) | (b.low.x > a.high.x) | (a.low.y > b.high.y) |
               (b.low.y > a.high.y) | (a.low.z > b.high.z) | (b.low.z > a.high.z);
    }

    void build(std::uint32_t begin, std::uint32_t end);

    std::span<const std::uint32_t> component_of_face_;
    std::vector<Box> boxes_; // [faces]
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_; // of nodes_, rising
};

} // namespace lodestone
