#include "simplify/collapse/crowd_growth.h"

#include "simplify/collapse/sequence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace lodestone {

namespace {

constexpr std::size_t kFewestParts = 48;
constexpr std::uint32_t kMostFaces = 24; // of a part
constexpr double kBorderEdges = 0.5;     // the fewest of a part, x its faces
constexpr double kFarLarger = 16.0;      // x the median area
constexpr double kLargestPart = 0.5;     // of the crowd's diagonal

struct Part {
    std::uint32_t component = 0;
    double area = 0.0;
    Bounds bounds;
};

struct Crowd {
    std::vector<Part> parts;
    std::vector<std::uint32_t> faces; // of the complex
    Bounds bounds;
};

glm::dvec3 vectorArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return 0.5 * glm::cross(b - a, c - a);
}

// How many edges of a component's faces are in one face alone; faces that stand back to back, as
// those of a leaf with two sides do, count as one.
double borderEdges(const Complex& complex, std::uint32_t begin, std::uint32_t end) {
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (std::uint32_t i = begin; i < end; ++i) {
        std::array<std::uint32_t, 3>& face = faces.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            face[k] = complex.wedge_vertex[complex.faces[complex.component_faces[i]][k]];
        std::ranges::sort(face);
    }
    std::ranges::sort(faces);
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& [a, b, c] : faces)
        edges.insert(edges.end(), {{a, b}, {b, c}, {a, c}});
    std::ranges::sort(edges);
    double alone = 0.0;
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const bool shared = (i > 0 && edges[i - 1] == edges[i]) ||
                            (i + 1 < edges.size() && edges[i + 1] == edges[i]);
        alone += shared ? 0.0 : 1.0;
    }
    return alone;
}

// A component that can be of a crowd; nullopt: too large, closed, or of several primitives.
std::optional<Part> partOf(const Complex& complex, std::uint32_t component) {
    const std::uint32_t begin = complex.component_begin[component];
    const std::uint32_t end = complex.component_begin[component + 1];
    if (end == begin || end - begin > kMostFaces)
        return std::nullopt;
    const std::size_t primitive = complex.primitiveOfFace(complex.component_faces[begin]);
    Part part{component, 0.0, {}};
    for (std::uint32_t i = begin; i < end; ++i) {
        const std::uint32_t face = complex.component_faces[i];
        if (complex.primitiveOfFace(face) != primitive)
            return std::nullopt;
        std::array<glm::dvec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = complex.positions[complex.wedge_vertex[complex.faces[face][k]]];
            part.bounds.add(corners[k]);
        }
        part.area += glm::length(vectorArea(corners[0], corners[1], corners[2]));
    }
    if (!(part.area > 0.0) ||
        borderEdges(complex, begin, end) < kBorderEdges * static_cast<double>(end - begin))
        return std::nullopt;
    return part;
}

std::vector<Crowd> findCrowds(const Complex& complex) {
    std::vector<Crowd> crowds(complex.face_begin.size() - 1); // [primitives]
    for (std::uint32_t c = 0; c < complex.componentCount(); ++c)
        if (const auto part = partOf(complex, c))
            crowds[complex.primitiveOfFace(complex.component_faces[complex.component_begin[c]])]
                .parts.push_back(*part);
    for (Crowd& crowd : crowds) {
        if (crowd.parts.size() >= kFewestParts) {
            std::vector<double> areas;
            for (const Part& part : crowd.parts)
                areas.push_back(part.area);
            const auto middle = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 2);
            std::ranges::nth_element(areas, middle);
            std::erase_if(crowd.parts,
                          [&](const Part& part) { return part.area > kFarLarger * *middle; });
        }
        if (crowd.parts.size() < kFewestParts)
            crowd.parts.clear();
        for (const Part& part : crowd.parts) {
            crowd.bounds.add(part.bounds.min);
            crowd.bounds.add(part.bounds.max);
            const std::uint32_t begin = complex.component_begin[part.component];
            const std::uint32_t end = complex.component_begin[part.component + 1];
            crowd.faces.insert(crowd.faces.end(),
                               complex.component_faces.begin() + begin,
                               complex.component_faces.begin() + end);
        }
    }
    return crowds;
}

// Of a crowd's faces that are left at a step.
double areaAt(const CollapseSequence& sequence,
              const Submesh& submesh,
              const Crowd& crowd,
              std::uint32_t step,
              std::vector<std::uint32_t>& stands_for) {
    resolveWedges(sequence, step, stands_for);
    double area = 0.0;
    for (const std::uint32_t face : crowd.faces) {
        if (sequence.face_death[face] <= step)
            continue;
        std::array<glm::dvec3, 3> corners;
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] =
                wedgePosition(sequence, submesh, stands_for[sequence.complex.faces[face][k]], step);
        area += glm::length(vectorArea(corners[0], corners[1], corners[2]));
    }
    return area;
}

// The largest factor that keeps every part smaller than half of the crowd.
double mostGrowth(const Crowd& crowd) {
    double largest = 0.0;
    for (const Part& part : crowd.parts)
        largest = std::max(largest, part.bounds.diagonal());
    return largest > 0.0 ? std::max(1.0, kLargestPart * crowd.bounds.diagonal() / largest) : 1.0;
}

std::vector<float> factorsOf(const CollapseSequence& sequence,
                             const Submesh& submesh,
                             const Crowd& crowd,
                             std::span<const std::uint32_t> faces_at) { // [steps + 1] falling
    std::vector<float> factors(faces_at.size(), 1.0f);
    std::vector<std::uint32_t> stands_for(sequence.complex.wedge_source.size());
    const double most = mostGrowth(crowd);
    double all = 0.0;
    for (const Part& part : crowd.parts)
        all += part.area;
    std::size_t before = 0;
    double factor_before = 1.0;
    for (double left = 0.7 * faces_at[0]; before + 1 < faces_at.size(); left *= 0.7) {
        const auto found = std::ranges::partition_point(
            faces_at, [&](std::uint32_t faces) { return static_cast<double>(faces) > left; });
        const auto at = std::clamp(
            static_cast<std::size_t>(found - faces_at.begin()), before + 1, faces_at.size() - 1);
        const double area =
            areaAt(sequence, submesh, crowd, static_cast<std::uint32_t>(at), stands_for);
        const double wanted = area > 0.0 ? std::sqrt(all / area) : factor_before;
        const double factor = std::clamp(wanted, factor_before, most);
        for (std::size_t s = before + 1; s <= at; ++s) {
            const double share = static_cast<double>(s - before) / static_cast<double>(at - before);
            factors[s] = static_cast<float>(factor_before + (factor - factor_before) * share);
        }
        before = at;
        factor_before = factor;
    }
    return factors;
}

} // namespace

CrowdGrowth growCrowds(const CollapseSequence& sequence, const Submesh& submesh) {
    const Complex& complex = sequence.complex;
    const std::vector<Crowd> crowds = findCrowds(complex);
    CrowdGrowth growth;
    if (std::ranges::all_of(crowds, [](const Crowd& crowd) { return crowd.parts.empty(); }))
        return growth;
    growth.part_of_wedge.assign(complex.wedge_source.size(), kNone);
    growth.factors.resize(crowds.size());
    for (std::size_t p = 0; p < crowds.size(); ++p) {
        for (const Part& part : crowds[p].parts) {
            for (std::uint32_t i = complex.component_begin[part.component];
                 i < complex.component_begin[part.component + 1];
                 ++i)
                for (const std::uint32_t wedge : complex.faces[complex.component_faces[i]])
                    growth.part_of_wedge[wedge] = static_cast<std::uint32_t>(growth.pivots.size());
            growth.pivots.emplace_back(part.bounds.center());
        }
        if (!crowds[p].parts.empty())
            growth.factors[p] = factorsOf(sequence, submesh, crowds[p], sequence.counts[p].faces);
    }
    return growth;
}

} // namespace lodestone
