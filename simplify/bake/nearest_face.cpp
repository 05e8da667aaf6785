#include "simplify/bake/nearest_face.h"

#include "simplify/bake/closest_point.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::uint32_t kLeafFaces = 4;
// x the squared distance of faces of other parts: a layer that lies beneath, as skin under clothes,
// shows only where the point's own part is more than twice as far.
constexpr float kOtherPart = 4.0f;
constexpr std::size_t kDepth = 64; // halving 2^32 faces takes 32 levels, each leaves one behind

} // namespace

float NearestFace::Node::squaredDistance(const glm::vec3& point) const {
    const glm::vec3 outside = glm::max(glm::max(low - point, point - high), glm::vec3(0.0f));
    return glm::dot(outside, outside);
}

NearestFace::Node NearestFace::boundsOf(std::uint32_t begin, std::uint32_t end) const {
    Node node{triangles_[order_[begin]][0], begin, triangles_[order_[begin]][0], end, 0};
    for (std::uint32_t i = begin; i < end; ++i)
        for (const glm::vec3& corner : triangles_[order_[i]]) {
            node.low = glm::min(node.low, corner);
            node.high = glm::max(node.high, corner);
        }
    return node;
}

std::uint32_t NearestFace::build(std::uint32_t begin, std::uint32_t end) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    const Node node = boundsOf(begin, end);
    nodes_.push_back(node);
    if (end - begin <= kLeafFaces)
        return at;
    const glm::vec3 extent = node.high - node.low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                     : extent.y >= extent.z                       ? 1
                                                                  : 2;
    const auto place = [&](std::uint32_t face) {
        const auto& t = triangles_[face];
        return t[0][axis] + t[1][axis] + t[2][axis];
    };
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin,
                     order_.begin() + middle,
                     order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float first = place(a);
                         const float second = place(b);
                         return first < second || (first == second && a < b);
                     });
    build(begin, middle);
    const std::uint32_t right = build(middle, end);
    nodes_[at].right = right;
    return at;
}

NearestFace::NearestFace(const Complex& complex, std::span<const glm::vec3> corners)
    : component_(complex.faces.size()), order_(complex.component_faces) {
    for (std::uint32_t c = 0; c < complex.componentCount(); ++c)
        for (std::uint32_t i = complex.component_begin[c]; i < complex.component_begin[c + 1]; ++i)
            component_[complex.component_faces[i]] = c;
    triangles_.reserve(complex.faces.size());
    for (const auto& face : complex.faces)
        triangles_.push_back({corners[face[0]], corners[face[1]], corners[face[2]]});
    if (!order_.empty())
        build(0, static_cast<std::uint32_t>(order_.size()));
}

std::uint32_t NearestFace::closest(const Query& query) const {
    const auto distance2 = [&](std::uint32_t face) {
        const auto& t = triangles_[face];
        const float apart = component_[face] == component_[query.near] ? 1.0f : kOtherPart;
        const glm::vec3 off = query.point - blended(t, closestOn(query.point, t));
        return apart * glm::dot(off, off);
    };
    std::uint32_t best = query.near;
    float best2 = distance2(best);
    std::array<std::uint32_t, kDepth> open{0};
    std::size_t count = 1;
    while (count > 0) {
        const std::uint32_t at = open[--count];
        const Node& node = nodes_[at];
        if (node.squaredDistance(query.point) >= best2)
            continue;
        if (node.right != 0) { // the nearer child on top
            const bool left_first = nodes_[at + 1].squaredDistance(query.point) <=
                                    nodes_[node.right].squaredDistance(query.point);
            open[count++] = left_first ? node.right : at + 1;
            open[count++] = left_first ? at + 1 : node.right;
            continue;
        }
        for (std::uint32_t i = node.begin; i < node.end; ++i) {
            const auto& t = triangles_[order_[i]];
            if (glm::dot(glm::cross(t[1] - t[0], t[2] - t[0]), query.normal) <= 0.0f)
                continue;
            const float found2 = distance2(order_[i]);
            if (found2 < best2) {
                best2 = found2;
                best = order_[i];
            }
        }
    }
    return best;
}

} // namespace lodestone
