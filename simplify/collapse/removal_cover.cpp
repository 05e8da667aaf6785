#include "simplify/collapse/removal_cover.h"

#include "scene/transformed_box.h"
#include "simplify/collapse/box_grid.h"
#include "simplify/collapse/box_tree.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr double kLarger = 4.0;                // x the area, to count as a cover
constexpr std::size_t kMaxTriangles = 100'000; // of all covers
constexpr double kCovered = 0.5;               // x the radius, at most
constexpr std::uint32_t kInstances = 6;        // of a submesh that are looked at
constexpr double kOff = 0.1;                   // x the least radius, that a cover may be

double scaleOf(const glm::dmat4& m) {
    return std::sqrt((glm::dot(glm::dvec3(m[0]), glm::dvec3(m[0])) +
                      glm::dot(glm::dvec3(m[1]), glm::dvec3(m[1])) +
                      glm::dot(glm::dvec3(m[2]), glm::dvec3(m[2]))) /
                     3.0);
}

double radiusOf(const SubmeshFacts& facts) {
    return 0.5 * facts.bounds.diagonal();
}

// World area of a submesh's mean instance.
double meanAreaOf(const Scene& scene, InstanceRange range, const SubmeshFacts& facts) {
    double scale2 = 0.0;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        const double scale = scaleOf(scene.instances[i].transform);
        scale2 += scale * scale;
    }
    return range.size() == 0 ? 0.0 : facts.area * scale2 / range.size();
}

// The coarsest step whose estimated distance is within the limit, in the submesh's units.
std::uint32_t stepWithin(const CollapseSequence& sequence, double limit) {
    const auto begin = sequence.error.begin();
    const auto end = begin + sequence.step_count;
    const auto beyond =
        std::find_if(begin, end, [&](float error) { return static_cast<double>(error) > limit; });
    return static_cast<std::uint32_t>(beyond - begin);
}

std::vector<BoxTree::Corners>
trianglesAt(const CollapseSequence& sequence, const Submesh& submesh, std::uint32_t step) {
    std::vector<std::uint32_t> stands_for(sequence.complex.wedge_source.size());
    resolveWedges(sequence, step, stands_for);
    std::vector<BoxTree::Corners> triangles;
    for (std::size_t f = 0; f < sequence.complex.faces.size(); ++f) {
        if (sequence.face_death[f] <= step)
            continue;
        BoxTree::Corners& corners = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            corners[k] =
                wedgePosition(sequence, submesh, stands_for[sequence.complex.faces[f][k]], step);
    }
    return triangles;
}

double stretchOf(const Scene& scene, InstanceRange range) {
    double stretch = 0.0;
    for (std::uint32_t i = range.begin; i < range.end; ++i)
        stretch = std::max(stretch, scaleOf(scene.instances[i].transform));
    return stretch;
}

class CoverFinder {
public:
    CoverFinder(const Scene& scene,
                std::span<const InstanceRange> ranges,
                std::span<const SubmeshFacts> facts)
        : scene_(scene), ranges_(ranges), facts_(facts), larger_(ranges.size(), 0),
          trees_(ranges.size()) {
        for (std::size_t s = 0; s < ranges.size(); ++s)
            mean_areas_.push_back(meanAreaOf(scene, ranges[s], facts[s]));
    }

    // False if nothing can be covered.
    bool gather(std::span<const CollapseSequence> sequences, double tolerance);

    Cover coverOf(std::size_t submesh) const;

private:
    struct Measured { // at a point
        double distance2 = 0.0;
        double cost2 = 0.0;
    };

    // An instance that may hide others.
    struct Larger {
        std::uint32_t submesh = 0;
        BoxTree::Placement placement;
    };

    void addInstances(std::uint32_t submesh, double tolerance, std::vector<Box>& boxes);
    Measured measure(std::size_t submesh, const glm::dvec3& world, double radius) const;

    const Scene& scene_;
    std::span<const InstanceRange> ranges_;
    std::span<const SubmeshFacts> facts_;       // [submeshes]
    std::vector<double> mean_areas_;            // [submeshes] of their instances, world
    std::vector<std::uint32_t> larger_;         // [submeshes] so many of instances_ are larger
    std::vector<std::optional<BoxTree>> trees_; // [submeshes]
    glm::dvec3 origin_{0.0};                    // of the grid's coordinates
    std::vector<Larger> instances_;
    BoxGrid grid_; // of instances_
};

void CoverFinder::addInstances(std::uint32_t submesh, double tolerance, std::vector<Box>& boxes) {
    Bounds local = localBounds(scene_.submeshes[submesh]);
    local.min -= tolerance; // what is left may lie a little outside
    local.max += tolerance;
    for (std::uint32_t i = ranges_[submesh].begin; i < ranges_[submesh].end; ++i) {
        const glm::dmat4& transform = scene_.instances[i].transform;
        const glm::vec3 offset(glm::dvec3(transform[3]) - origin_);
        instances_.push_back({submesh, {glm::mat3(glm::dmat3(transform)), offset}});
        const Bounds box = transformedBox(transform, local);
        boxes.push_back({glm::vec3(box.min - origin_), glm::vec3(box.max - origin_)});
    }
}

bool CoverFinder::gather(std::span<const CollapseSequence> sequences, double tolerance) {
    double least = std::numeric_limits<double>::infinity(); // area of what may need a cover
    double least_radius = least;
    for (std::size_t s = 0; s < ranges_.size(); ++s) {
        if (ranges_[s].size() < 2 || !(mean_areas_[s] > 0.0))
            continue;
        least = std::min(least, mean_areas_[s]);
        least_radius = std::min(least_radius,
                                radiusOf(facts_[s]) * std::sqrt(mean_areas_[s] / facts_[s].area));
    }
    tolerance = std::max(tolerance, kOff * least_radius);
    std::vector<std::uint32_t> order(ranges_.size()); // the largest first
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(
        order, std::greater{}, [&](std::uint32_t s) { return mean_areas_[s]; });
    std::vector<Box> boxes;
    std::size_t triangles = 0;
    std::size_t covered = 0; // of order: those that already know what is larger
    for (const std::uint32_t s : order) {
        const double area = mean_areas_[s];
        if (!(area >= kLarger * least))
            break;
        for (; covered < order.size() && area < kLarger * mean_areas_[order[covered]]; ++covered)
            larger_[order[covered]] = static_cast<std::uint32_t>(boxes.size());
        const double stretch = stretchOf(scene_, ranges_[s]);
        const double local_tolerance = stretch > 0.0 ? tolerance / stretch : 0.0;
        const std::uint32_t step = stepWithin(sequences[s], local_tolerance);
        const std::vector<BoxTree::Corners> local =
            trianglesAt(sequences[s], scene_.submeshes[s], step);
        triangles += local.size() * ranges_[s].size();
        if (triangles > kMaxTriangles)
            break;
        if (boxes.empty())
            origin_ = glm::dvec3(scene_.instances[ranges_[s].begin].transform[3]);
        trees_[s].emplace(local);
        addInstances(s, local_tolerance, boxes);
    }
    for (; covered < order.size(); ++covered)
        larger_[order[covered]] = static_cast<std::uint32_t>(boxes.size());
    grid_ = BoxGrid(std::move(boxes));
    return !grid_.empty();
}

CoverFinder::Measured
CoverFinder::measure(std::size_t submesh, const glm::dvec3& world, double radius) const {
    const SubmeshFacts& own = facts_[submesh];
    const glm::vec3 at(world - origin_);
    Measured best{radius * radius, radius * radius};
    const auto visit = [&](std::uint32_t index) {
        const auto& [larger, placement] = instances_[index];
        const glm::dvec3 contrast = (facts_[larger].color - own.color) * (0.5 * radius);
        const double cost_of_color = glm::dot(contrast, contrast) / 3.0;
        const auto limit = static_cast<float>(best.cost2 - cost_of_color);
        const float distance2 =
            limit > 0.0f ? trees_[larger]->nearest(at, placement, limit) : limit;
        if (distance2 < limit)
            best = {static_cast<double>(distance2), static_cast<double>(distance2) + cost_of_color};
        return static_cast<float>(std::sqrt(best.cost2));
    };
    grid_.visitNear(at, static_cast<float>(radius), larger_[submesh], visit);
    return best;
}

Cover CoverFinder::coverOf(std::size_t submesh) const {
    const InstanceRange range = ranges_[submesh];
    const SubmeshFacts& own = facts_[submesh];
    if (range.size() < 2 || !(mean_areas_[submesh] > 0.0) || larger_[submesh] == 0)
        return {};
    const std::uint32_t count = std::min(range.size(), kInstances);
    const auto transform_of = [&](std::uint32_t k) -> const glm::dmat4& {
        const auto offset = std::uint64_t{k} * range.size() / count;
        return scene_.instances[range.begin + static_cast<std::uint32_t>(offset)].transform;
    };
    const auto points_an_instance = static_cast<double>(own.points.size());
    double reach2 = 0.0;
    for (std::uint32_t k = 0; k < count; ++k) {
        const double reach = kCovered * radiusOf(own) * scaleOf(transform_of(k));
        reach2 += points_an_instance * reach * reach;
    }
    Measured sum;
    for (std::uint32_t k = 0; k < count; ++k) {
        const glm::dmat4& transform = transform_of(k);
        const double radius = radiusOf(own) * scaleOf(transform);
        for (const glm::dvec3& point : own.points) {
            const Measured measured =
                measure(submesh, glm::dvec3(transform * glm::dvec4(point, 1.0)), radius);
            sum.distance2 += measured.distance2;
            sum.cost2 += measured.cost2;
            if (!(sum.cost2 <= reach2)) // as most are, and soon
                return {};
        }
    }
    const double points = points_an_instance * static_cast<double>(count);
    return {std::sqrt(sum.distance2 / points), std::sqrt(sum.cost2 / points)};
}

} // namespace

std::vector<Cover> findCovers(const Scene& scene,
                              std::span<const InstanceRange> ranges,
                              std::span<const SubmeshFacts> facts,
                              std::span<const CollapseSequence> sequences,
                              double tolerance) {
    std::vector<Cover> covers(ranges.size());
    CoverFinder finder(scene, ranges, facts);
    if (finder.gather(sequences, tolerance))
        tbb::parallel_for(
            std::size_t{0}, covers.size(), [&](std::size_t s) { covers[s] = finder.coverOf(s); });
    return covers;
}

} // namespace lodestone
