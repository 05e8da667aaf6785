#include "simplify/collapse/box_tree.h"

#include "simplify/measure/triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone {

namespace {

// No linear map stretches anything by more than the root of the largest row sum of its Gram matrix;
// exact where the axes stay at right angles.
float mostStretch2(const glm::mat3& linear) {
    const glm::mat3 gram = glm::transpose(linear) * linear;
    float most = 0.0f;
    for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(gram[c].x) + std::abs(gram[c].y) + std::abs(gram[c].z));
    return most;
}

} // namespace

BoxTree::Placement::Placement(const glm::mat3& map, const glm::vec3& to)
    : linear(map), offset(to), inverse(glm::inverse(map)),
      least_stretch2(1.0f / mostStretch2(inverse)) {
    if (std::isfinite(least_stretch2))
        return;
    inverse = glm::mat3(0.0f); // flat: what it holds may be anywhere
    least_stretch2 = 0.0f;
}

BoxTree::BoxTree(std::span<const Corners> triangles) {
    if (triangles.empty())
        return;
    std::vector<Middle> middles; // x 3
    middles.reserve(triangles.size());
    for (const auto& [a, b, c] : triangles)
        middles.push_back({a + b + c, static_cast<std::uint32_t>(middles.size())});
    nodes_.reserve(triangles.size());
    triangles_.reserve(triangles.size());
    build(triangles, middles);
}

// Halves at the median of the middles' longest axis: depth log2 whatever the input.
Box BoxTree::build(std::span<const Corners> triangles, std::span<Middle> middles) {
    constexpr std::size_t kLeaf = 4;
    const std::size_t self = nodes_.size();
    nodes_.emplace_back();
    Node node;
    Box box{glm::vec3(std::numeric_limits<float>::max()),
            glm::vec3(std::numeric_limits<float>::lowest())};
    const auto add = [&](const Box& other) {
        box = {glm::min(box.low, other.low), glm::max(box.high, other.high)};
    };
    if (middles.size() > kLeaf) {
        for (const Middle& middle : middles)
            add({middle.at, middle.at});
        const glm::vec3 size = box.high - box.low;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const std::size_t half = middles.size() / 2;
        std::ranges::nth_element(middles,
                                 middles.begin() + static_cast<std::ptrdiff_t>(half),
                                 {},
                                 [&](const Middle& middle) { return middle.at[axis]; });
        box = build(triangles, middles.first(half));
        node.second = static_cast<std::uint32_t>(nodes_.size());
        add(build(triangles, middles.subspan(half)));
    } else {
        node.begin = static_cast<std::uint32_t>(triangles_.size());
        for (const Middle& middle : middles) {
            triangles_.push_back(triangles[middle.triangle]);
            for (const glm::vec3& corner : triangles_.back())
                add({corner, corner});
        }
        node.end = static_cast<std::uint32_t>(triangles_.size());
    }
    node.box = box;
    nodes_[self] = node;
    return box;
}

float BoxTree::nearest(const glm::vec3& point, const Placement& placement, float limit) const {
    struct Waiting {
        std::uint32_t node = 0;
        float least2 = 0.0f; // no triangle of it is nearer
    };

    const glm::vec3 local = placement.inverse * (point - placement.offset);
    const auto waiting = [&](std::uint32_t node) {
        return Waiting{node, nodes_[node].box.squaredDistance(local) * placement.least_stretch2};
    };
    std::array<Waiting, 40> stack; // one a level
    std::size_t count = 0;
    if (!nodes_.empty())
        stack[count++] = waiting(0);
    while (count > 0) {
        const auto [at, least2] = stack[--count];
        if (least2 >= limit)
            continue;
        const Node& node = nodes_[at];
        if (node.second != 0) {
            const Waiting first = waiting(at + 1);
            const Waiting second = waiting(node.second);
            const bool swap = second.least2 < first.least2;
            stack[count++] = swap ? first : second;
            stack[count++] = swap ? second : first;
            continue;
        }
        for (std::uint32_t t = node.begin; t < node.end; ++t) {
            Triangle placed;
            for (std::size_t k = 0; k < 3; ++k)
                placed[k] = glm::dvec3(placement.linear * triangles_[t][k] + placement.offset);
            limit = std::min(limit, static_cast<float>(squaredDistance(glm::dvec3(point), placed)));
        }
    }
    return limit;
}

} // namespace lodestone
