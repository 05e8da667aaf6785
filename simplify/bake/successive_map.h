#pragma once
// From a point of a simplified submesh back to the surface it came from (Wild, section 7): vertex
// splits are replayed from coarse to fine, and at each the point moves to the nearest triangle of
// the split edge's one-ring. The point itself stays where it was sampled, so nothing drifts; that
// only one-rings are searched keeps it on its own sheet, where a closest point of the whole surface
// may lie on the far side of a thin wall. What the one-rings have missed is found at the end, by a
// search of the original surface that faces the same way (NearestFace); splits of a surface that is
// much finer than the simplified one are left to it.
#include "simplify/bake/nearest_face.h"
#include "simplify/collapse/sequence.h"

#include <optional>

namespace lodestone {

class SuccessiveMap {
public:
    // The sequence outlives the map. step <= its recorded steps. Submesh units throughout.
    // O(sum of valences of the steps) time and memory. Stops early where asked to.
    SuccessiveMap(const CollapseSequence& sequence,
                  const Submesh& submesh,
                  std::uint32_t step,
                  const JobContext& job);

    // Faces of the complex that are alive at the step, by primitive, in the order of a read-out.
    std::span<const std::uint32_t> facesOf(std::size_t primitive) const {
        return {alive_.data() + alive_begin_[primitive],
                alive_begin_[primitive + 1] - alive_begin_[primitive]};
    }

    // Corners at the step of a face that is alive then.
    std::array<glm::vec3, 3> triangle(std::uint32_t face) const;

    struct Hit {
        std::uint32_t face = 0;  // of the complex, at step 0
        glm::vec3 weights{0.0f}; // of its corners; in [0, 1], sum 1
    };

    // point: on a face alive at the step; normal: of the side that it is seen from, any length.
    // O(splits of that face's corners). Any thread.
    Hit trace(std::uint32_t face, const glm::vec3& point, const glm::vec3& normal) const;

private:
    struct Replay;

    // A triangle of a split's one-ring, as it lies before the collapse.
    struct Candidate {
        std::uint32_t face = 0;
        float radius = 0.0f; // about the centre
        std::array<glm::vec3, 3> corners;
    };

    // A step whose collapse a face outlived.
    struct Split {
        std::uint32_t step = 0;
        std::size_t own = 0; // of the candidates: the face itself
    };

    const CollapseSequence& sequence_;
    std::vector<std::uint32_t> alive_;
    std::vector<std::uint32_t> alive_begin_;           // [primitives + 1]
    std::vector<std::array<std::uint32_t, 3>> wedges_; // [faces] at the step
    std::vector<glm::vec3> positions_;                 // [wedges] at the step, of those alive
    std::vector<glm::vec3> originals_;                 // [wedges] at step 0
    std::vector<Candidate> candidates_;
    std::vector<std::size_t> candidate_begin_; // [steps + 1] of step s at s - 1
    std::vector<Split> splits_;                // of each face, rising
    std::vector<std::size_t> split_begin_;     // [faces + 1]
    std::optional<NearestFace> nearest_;       // of the originals
};

} // namespace lodestone
