#include "simplify/collapse/sequence.h"
#include "simplify/shape_floor.h"

#include <algorithm>

namespace lodestone {

namespace {

ShapeMeasure
measureAt(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step) {
    const Complex& complex = sequence.complex;
    std::vector<std::uint32_t> stands_for(complex.wedge_source.size());
    resolveWedges(sequence, step, stands_for);
    ShapeMeasure measure;
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
        measure.add(corner);
    }
    return measure;
}

// Of a share of its axes, the share of its area that a shape keeps with it: half with four fifths.
constexpr double kAreaOfExtent = 0.625;

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
    if (instance_count < floors.min_crowd || limit == 0)
        return limit;
    const ShapeMeasure whole = measureAt(sequence, submesh, 0);
    const auto passes = [&](std::uint32_t step) {
        return keepsShape(measureAt(sequence, submesh, step),
                          whole,
                          {floors.min_shape, kAreaOfExtent * floors.min_shape});
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
