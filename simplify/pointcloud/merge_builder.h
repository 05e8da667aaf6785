#pragma once
// Collects the merges of one pass: union-find over vertices, each with its current place.
#include "simplify/pointcloud/methods.h"

namespace lodestone {

class MergeBuilder {
public:
    // Sound: merges that would turn a remaining face by more than 80 degrees are refused.
    MergeBuilder(const CloudSurface& surface, Fidelity fidelity);

    std::uint32_t find(std::uint32_t vertex);

    const glm::dvec3& position(std::uint32_t root) const { return merges_.positions[root]; }

    // Corners of a face as roots, and where they are.
    Triangle rootsOf(std::size_t face);
    Triangle3d pointsOf(const Triangle& roots) const;

    // Makes these distinct roots one vertex at a place. False if refused. Amortised near O(faces
    // around them).
    bool merge(std::span<const std::uint32_t> roots, const glm::dvec3& place);

    // The same without a check.
    void mergeAnyway(std::span<const std::uint32_t> roots, const glm::dvec3& place);

    // Whether merging them there would turn a face. Not for Literal.
    bool turnsFace(std::span<const std::uint32_t> roots, const glm::dvec3& place);

    Merges finish();

private:
    struct Link {
        std::uint32_t face = 0;
        std::uint32_t next = kNone;
    };

    void linkFaces();
    // Takes a face that has collapsed out of a root's list; previous: the link before it or kNone.
    void unlink(std::uint32_t root, std::uint32_t link, std::uint32_t previous);

    const CloudSurface& surface_;
    Fidelity fidelity_;
    Merges merges_; // target: parents
    // Faces around each root as lists that merge in O(1); faces that have collapsed drop out when
    // a list is walked.
    std::vector<Link> links_;
    std::vector<std::uint32_t> first_; // [vertices] into links_
    std::vector<std::uint32_t> last_;  // [vertices] into links_
    std::vector<std::uint32_t> mark_;  // [vertices] stamp_: about to merge
    std::uint32_t stamp_ = 0;
};

} // namespace lodestone
