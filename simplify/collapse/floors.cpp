#include "simplify/collapse/sequence.h"

#include <algorithm>

namespace lodestone {

namespace {

struct Measure {
    Bounds bounds;
    double area = 0.0;
};

Measure measureAt(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step) {
    const Complex& complex = sequence.complex;
    std::vector<std::uint32_t> stands_for(complex.wedge_source.size());
    resolveWedges(sequence, step, stands_for);
    Measure measure;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (sequence.face_death[f] <= step)
            continue;
        std::array<glm::dvec3, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t wedge = stands_for[complex.faces[f][k]];
            corner[k] = glm::dvec3(wedgePosition(sequence, submesh, wedge, step));
        }
        if (!std::ranges::all_of(corner, [&](const auto& p) { return complex.bulk.holds(p); }))
            continue;
        for (const glm::dvec3& p : corner)
            measure.bounds.add(p);
        measure.area += 0.5 * glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
    }
    return measure;
}

// The extents that must stay. A leaf's sag is not its size: an axis less than a quarter as long as
// both others does not count. The height of a flat house is.
glm::dvec3 leastExtents(const glm::dvec3& size, double share) {
    glm::dvec3 least = size * share;
    for (int axis = 0; axis < 3; ++axis)
        if (4.0 * size[axis] < std::min(size[(axis + 1) % 3], size[(axis + 2) % 3]))
            least[axis] = 0.0;
    return least;
}

// The last step with at least that many triangles.
std::uint32_t lastStepWith(const CollapseSequence& sequence, std::uint32_t triangles) {
    std::uint32_t low = 0;
    std::uint32_t high = sequence.recordedSteps();
    while (low < high) {
        const std::uint32_t middle = low + (high - low + 1) / 2;
        if (sequence.facesAt(middle) >= triangles)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

} // namespace

std::uint32_t floorStep(const CollapseSequence& sequence,
                        const Submesh& submesh,
                        std::uint32_t instance_count,
                        const FloorOptions& floors) {
    if (!floors.enabled)
        return sequence.recordedSteps();
    const auto clean = static_cast<std::uint32_t>(sequence.complex.faces.size());
    const std::uint32_t limit = lastStepWith(sequence, std::min(floors.min_triangles, clean));
    if (instance_count < 2 || limit == 0)
        return limit;
    const Measure whole = measureAt(sequence, submesh, 0);
    const glm::dvec3 least = leastExtents(whole.bounds.size(), floors.min_extent);
    const auto passes = [&](std::uint32_t step) {
        const Measure now = measureAt(sequence, submesh, step);
        const glm::dvec3 size = now.bounds.size();
        const double slack = 1e-9 * whole.bounds.diagonal();
        return size.x + slack >= least.x && size.y + slack >= least.y &&
               size.z + slack >= least.z && now.area >= floors.min_area * whole.area;
    };
    // Extent and area fall slowly at first: look from the coarse end, halving the way back, then
    // bisect. Each look costs what is left of the mesh, and the coarse end is cheap.
    if (passes(limit))
        return limit;
    std::uint32_t good = 0;
    std::uint32_t bad = limit;
    for (std::uint32_t back = 1; back < limit; back *= 2) {
        if (passes(limit - back)) {
            good = limit - back;
            break;
        }
        bad = limit - back;
    }
    while (bad - good > 1) {
        const std::uint32_t middle = good + (bad - good) / 2;
        (passes(middle) ? good : bad) = middle;
    }
    return std::max(good, sequence.complex.dropped_faces > 0 ? 1u : 0u); // cleaning changes nothing
}

} // namespace lodestone
