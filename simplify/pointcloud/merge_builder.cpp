#include "simplify/pointcloud/merge_builder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone {

MergeBuilder::MergeBuilder(const CloudSurface& surface, Fidelity fidelity, const JobContext& job)
    : fidelity_(fidelity), merged_(surface.positions.size(), 0) {
    merges_.target.resize(surface.positions.size());
    std::iota(merges_.target.begin(), merges_.target.end(), 0u);
    merges_.positions = surface.positions;
    if (job.stopRequested())
        return;
    corners_.resize(surface.faces.size());
    for (std::size_t f = 0; f < corners_.size() && !stopsAt(f, job); ++f)
        corners_[f] = surface.corners(f);
    if (fidelity == Fidelity::Sound)
        linkFaces(job);
}

void MergeBuilder::linkFaces(const JobContext& job) {
    if (job.stopRequested())
        return;
    const std::size_t vertices = merges_.target.size();
    first_.assign(vertices, kNone);
    last_.assign(vertices, kNone);
    mark_.assign(vertices, 0);
    next_.assign(3 * corners_.size(), kNone);
    for (std::uint32_t link = 0; link < next_.size() && !stopsAt(link, job); ++link) {
        const std::uint32_t vertex = corners_[link / 3][link % 3];
        if (first_[vertex] == kNone)
            first_[vertex] = link;
        else
            next_[last_[vertex]] = link;
        last_[vertex] = link;
    }
}

void MergeBuilder::unlink(std::uint32_t root, std::uint32_t link, std::uint32_t previous) {
    (previous == kNone ? first_[root] : next_[previous]) = next_[link];
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
        for (std::uint32_t link = first_[root]; link != kNone; link = next_[link]) {
            const Triangle corners = rootsOf(link / 3);
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
        merged_[root] = 1;
        if (root == kept)
            continue;
        merges_.target[root] = kept;
        if (fidelity_ == Fidelity::Literal || first_[root] == kNone)
            continue;
        if (first_[kept] == kNone)
            first_[kept] = first_[root];
        else
            next_[last_[kept]] = first_[root];
        last_[kept] = last_[root];
    }
    merges_.positions[kept] = place;
}

// Centres of symmetric neighbours can be one place, in the file's floats at least: then they are
// one vertex, or a face between them would be left without area.
void MergeBuilder::mergeAtOnePlace() {
    for (std::size_t f = 0; f < corners_.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle roots = rootsOf(f);
            const std::array pair{roots[k], roots[(k + 1) % 3]};
            if (pair[0] != pair[1] && glm::vec3(position(pair[0])) == glm::vec3(position(pair[1])))
                mergeAnyway(pair, position(std::min(pair[0], pair[1])));
        }
}

Merges MergeBuilder::finish() {
    mergeAtOnePlace();
    for (std::uint32_t v = 0; v < merges_.target.size(); ++v)
        merges_.target[v] = find(v);
    return std::move(merges_);
}

} // namespace lodestone
