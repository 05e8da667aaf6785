#include "simplify/collapse/seam_count.h"

#include <algorithm>

namespace lodestone {

SeamCount
countOnSeams(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step) {
    std::vector<std::array<float, 3>> places;
    for (std::uint32_t wedge = 0; wedge < sequence.wedge_death.size(); ++wedge)
        if (sequence.wedge_death[wedge] > step) {
            const glm::vec3 p = wedgePosition(sequence, submesh, wedge, step);
            places.push_back({p.x, p.y, p.z});
        }
    std::ranges::sort(places);
    SeamCount count;
    for (std::size_t begin = 0; begin < places.size();) {
        std::size_t end = begin + 1;
        while (end < places.size() && places[end] == places[begin])
            ++end;
        ++count.vertices;
        count.on_seams += end - begin > 1 ? 1 : 0;
        begin = end;
    }
    return count;
}

} // namespace lodestone
