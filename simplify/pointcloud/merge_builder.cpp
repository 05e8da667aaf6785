#include "simplify/pointcloud/merge_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {

MergeBuilder::MergeBuilder(const CloudSurface& surface, Fidelity fidelity)
    : surface_(surface), fidelity_(fidelity) {
    merges_.target.resize(surface.positions.size());
    std::iota(merges_.target.begin(), merges_.target.end(), 0u);
    merges_.positions = surface.positions;
    if (fidelity == Fidelity::Sound)
        linkFaces();
}

void MergeBuilder::linkFaces() {
    first_.assign(surface_.positions.size(), kNone);
    last_.assign(surface_.positions.size(), kNone);
    mark_.assign(surface_.positions.size(), 0);
    links_.reserve(3 * surface_.faces.size());
    for (std::uint32_t f = 0; f < surface_.faces.size(); ++f)
        for (const std::uint32_t vertex : surface_.corners(f)) {
            const auto link = static_cast<std::uint32_t>(links_.size());
            links_.push_back({f, kNone});
            if (first_[vertex] == kNone)
                first_[vertex] = link;
            else
                links_[last_[vertex]].next = link;
            last_[vertex] = link;
        }
}

std::uint32_t MergeBuilder::find(std::uint32_t vertex) {
    std::vector<std::uint32_t>& parent = merges_.target;
    while (parent[vertex] != vertex) {
        parent[vertex] = parent[parent[vertex]];
        vertex = parent[vertex];
    }
    return vertex;
}

Triangle MergeBuilder::rootsOf(std::size_t face) {
    Triangle roots = surface_.corners(face);
    for (std::uint32_t& root : roots)
        root = find(root);
    return roots;
}

Triangle3d MergeBuilder::pointsOf(const Triangle& roots) const {
    return {position(roots[0]), position(roots[1]), position(roots[2])};
}

void MergeBuilder::unlink(std::uint32_t root, std::uint32_t link, std::uint32_t previous) {
    (previous == kNone ? first_[root] : links_[previous].next) = links_[link].next;
    if (last_[root] == link)
        last_[root] = previous;
}

bool MergeBuilder::turnsFace(std::span<const std::uint32_t> roots, const glm::dvec3& place) {
    constexpr double kLeastCosine = 0.17; // 80 degrees
    ++stamp_;
    for (const std::uint32_t root : roots)
        mark_[root] = stamp_;
    for (const std::uint32_t root : roots) {
        std::uint32_t previous = kNone;
        for (std::uint32_t link = first_[root]; link != kNone; link = links_[link].next) {
            const Triangle corners = rootsOf(links_[link].face);
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[0] == corners[2]) {
                unlink(root, link, previous);
                continue;
            }
            previous = link;
            Triangle3d after = pointsOf(corners);
            const glm::dvec3 normal = faceVector(after);
            int moved = 0;
            for (std::size_t k = 0; k < 3; ++k)
                if (mark_[corners[k]] == stamp_) {
                    after[k] = place;
                    ++moved;
                }
            if (moved > 1)
                continue; // collapses
            const glm::dvec3 turned = faceVector(after);
            const double lengths = std::sqrt(glm::dot(normal, normal) * glm::dot(turned, turned));
            if (lengths > 0.0 && glm::dot(normal, turned) < kLeastCosine * lengths)
                return true;
        }
    }
    return false;
}

bool MergeBuilder::merge(std::span<const std::uint32_t> roots, const glm::dvec3& place) {
    if (fidelity_ == Fidelity::Sound && turnsFace(roots, place))
        return false;
    mergeAnyway(roots, place);
    return true;
}

void MergeBuilder::mergeAnyway(std::span<const std::uint32_t> roots, const glm::dvec3& place) {
    const std::uint32_t kept = *std::ranges::min_element(roots);
    for (const std::uint32_t root : roots) {
        if (root == kept)
            continue;
        merges_.target[root] = kept;
        if (fidelity_ == Fidelity::Literal || first_[root] == kNone)
            continue;
        if (first_[kept] == kNone)
            first_[kept] = first_[root];
        else
            links_[last_[kept]].next = first_[root];
        last_[kept] = last_[root];
    }
    merges_.positions[kept] = place;
}

Merges MergeBuilder::finish() {
    for (std::uint32_t v = 0; v < merges_.target.size(); ++v)
        merges_.target[v] = find(v);
    return std::move(merges_);
}

} // namespace lodestone
