#include "simplify/wild/triangle_tree.h"

#include <algorithm>
#include <numeric>

namespace lodestone {

TriangleTree::TriangleTree(const Complex& complex, std::span<const std::uint32_t> component_of_face)
    : component_of_face_(component_of_face) {
    boxes_.resize(complex.faces.size());
    for (std::size_t f = 0; f < boxes_.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::vec3& p = complex.positions[complex.wedge_vertex[complex.faces[f][k]]];
            boxes_[f].low = k == 0 ? p : glm::min(boxes_[f].low, p);
            boxes_[f].high = k == 0 ? p : glm::max(boxes_[f].high, p);
        }
    order_.resize(boxes_.size());
    std::iota(order_.begin(), order_.end(), 0u);
    nodes_.reserve(boxes_.size());
    if (!boxes_.empty())
        build(0, static_cast<std::uint32_t>(boxes_.size()));
}

// Halves at the median of the longest axis: depth log2 whatever the input.
void TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t kLeaf = 4;
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    Node node;
    node.box = boxes_[order_[begin]];
    node.component = component_of_face_[order_[begin]];
    for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t face = order_[i];
        node.box.low = glm::min(node.box.low, boxes_[face].low);
        node.box.high = glm::max(node.box.high, boxes_[face].high);
        if (component_of_face_[face] != node.component)
            node.component = kNone;
    }
    if (end - begin <= kLeaf) {
        node.begin = begin;
        node.end = end;
        leaves_.push_back(static_cast<std::uint32_t>(self));
    } else {
        const glm::vec3 size = node.box.high - node.box.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const auto key = [&](std::uint32_t face) {
            return std::pair(boxes_[face].low[axis] + boxes_[face].high[axis], face);
        };
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::ranges::nth_element(
            order_.begin() + begin, order_.begin() + middle, order_.begin() + end, {}, key);
        build(begin, middle);
        build(middle, end);
    }
    node.skip_to = static_cast<std::uint32_t>(nodes_.size());
    nodes_[self] = node;
}

} // namespace lodestone
