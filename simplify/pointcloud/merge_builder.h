#pragma once
// Collects the merges of one pass: union-find over vertices, each with its current place.
#include "simplify/pointcloud/methods.h"

namespace lodestone {

class MergeBuilder {
public:
    // Sound: merges that would turn a remaining face by more than 80 degrees are refused.
    // job: not kept; where it is to stop the builder is fit to be dropped alone.
    MergeBuilder(const CloudSurface& surface, Fidelity fidelity, const JobContext& job);

    std::uint32_t find(std::uint32_t vertex) {
        std::vector<std::uint32_t>& parent = merges_.target;
        while (parent[vertex] != vertex) {
            parent[vertex] = parent[parent[vertex]];
            vertex = parent[vertex];
        }
        return vertex;
    }

    const glm::dvec3& position(std::uint32_t root) const { return merges_.positions[root]; }

    // Corners of a face as roots, and where they are.
    Triangle rootsOf(std::size_t face) {
        Triangle& corners = corners_[face];
        for (std::uint32_t& corner : corners)
            corner = find(corner);
        return corners;
    }

    Triangle3d pointsOf(const Triangle& roots) const {
        return {position(roots[0]), position(roots[1]), position(roots[2])};
    }

    // Whether no corner of a face has merged: it is where it was.
    bool isUntouched(std::size_t face) const {
        const Triangle& corners = corners_[face];
        return !merged_[corners[0]] && !merged_[corners[1]] && !merged_[corners[2]];
    }

    // Makes these distinct roots one vertex at a place. False if refused. Amortised near O(faces
    // around them).
    bool merge(std::span<const std::uint32_t> roots, const glm::dvec3& place);

    // The same without a check.
    void mergeAnyway(std::span<const std::uint32_t> roots, const glm::dvec3& place);

    // Whether merging them there would turn a face. Not for Literal.
    bool turnsFace(std::span<const std::uint32_t> roots, const glm::dvec3& place);

    Merges finish();

private:
    void mergeAtOnePlace();
    void linkFaces(const JobContext& job);
    // Takes a face that has collapsed out of a root's list; previous: the link before it or kNone.
    void unlink(std::uint32_t root, std::uint32_t link, std::uint32_t previous);

    Fidelity fidelity_;
    Merges merges_;                    // target: parents
    std::vector<Triangle> corners_;    // [faces] roots when last looked at
    std::vector<std::uint8_t> merged_; // [vertices]
    // Faces around each root as lists that merge in O(1); faces that have collapsed drop out when
    // a list is walked. A link is a corner: 3 * face + which.
    std::vector<std::uint32_t> next_;  // [links]
    std::vector<std::uint32_t> first_; // [vertices] link
    std::vector<std::uint32_t> last_;  // [vertices] link
    std::vector<std::uint32_t> mark_;  // [vertices] stamp_: about to merge
    std::uint32_t stamp_ = 0;
};

} // namespace lodestone
