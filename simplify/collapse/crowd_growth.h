#pragma once
// Crowds of small open parts in one mesh, as the leaves of a tree are: where parts vanish, those
// that are left grow, so that together they cover as much as before. What instances do that stand
// for removed ones, for parts that are no instances.
#include "scene/scene.h"

namespace lodestone {

struct CollapseSequence;

// Empty: the submesh has no crowd.
struct CrowdGrowth {
    std::vector<std::uint32_t> part_of_wedge; // [wedges] into pivots; kNone: of no crowd
    std::vector<glm::vec3> pivots;            // [parts] they grow about
    std::vector<std::vector<float>> factors;  // [primitives][steps + 1] >= 1, never falling

    // Where a wedge that lies at `position` at a step is drawn.
    glm::vec3 grown(std::size_t primitive,
                    std::uint32_t wedge,
                    std::uint32_t step,
                    const glm::vec3& position) const {
        if (part_of_wedge.empty() || part_of_wedge[wedge] == kNone)
            return position;
        const glm::vec3& pivot = pivots[part_of_wedge[wedge]];
        return pivot + (position - pivot) * factors[primitive][step];
    }
};

// The crowds of a submesh: in each primitive the parts of few faces and much border, if there are
// many, without the few that are far larger. Their area is measured each time that three tenths of
// the faces are gone, and factors in between interpolated; no part grows beyond half of its crowd.
// sequence: whole, without growth.
// O((faces + wedges) log faces) where there are crowds, else O(faces). Any thread.
CrowdGrowth growCrowds(const CollapseSequence& sequence, const Submesh& submesh);

} // namespace lodestone
