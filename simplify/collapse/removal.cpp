#include "simplify/collapse/removal.h"

#include "scene/morton.h"
#include "simplify/collapse/removal_grid.h"
#include "simplify/collapse/removal_order.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone {

namespace {

// World area of an instance: sqrt of the mean of |C n|^2, exact for similarities.
double instanceArea(const SubmeshFacts& facts, const glm::dmat3& m) {
    const glm::dmat3 cofactor(
        glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    double squared = 0.0; // trace(C^T C N), N the symmetric normal moment
    for (int c = 0; c < 3; ++c) {
        squared += glm::dot(cofactor[c], cofactor[c]) * facts.normal_moment[c][c];
        const int d = (c + 1) % 3;
        squared += 2.0 * glm::dot(cofactor[c], cofactor[d]) * facts.normal_moment[c][d];
    }
    return facts.area * std::sqrt(std::max(0.0, squared));
}

// How far a transformed box reaches from the pivot before it leaves the model's bounds, x its size.
double roomOf(const glm::dmat3& m,
              const Bounds& about_pivot,
              const glm::dvec3& to_low,
              const glm::dvec3& to_high) {
    glm::dvec3 low(0.0);
    glm::dvec3 high(0.0);
    for (int c = 0; c < 3; ++c) {
        const glm::dvec3 a = m[c] * about_pivot.min[c];
        const glm::dvec3 b = m[c] * about_pivot.max[c];
        low += glm::min(a, b);
        high += glm::max(a, b);
    }
    double room = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
        if (low[axis] < 0.0)
            room = std::min(room, to_low[axis] / -low[axis]);
        if (high[axis] > 0.0)
            room = std::min(room, to_high[axis] / high[axis]);
    }
    return room;
}

struct Crowd {
    std::vector<Member> members; // along a Morton curve over their own bounds
    Bounds spots;                // of their pivots
};

Crowd crowdOf(const Scene& scene,
              InstanceRange range,
              const SubmeshFacts& facts,
              const Bounds& scene_bounds) {
    std::vector<Member> members(range.size());
    std::vector<glm::dvec3> places;
    places.reserve(members.size());
    Bounds spots;
    Bounds about_pivot;
    about_pivot.min = facts.bounds.min - facts.pivot;
    about_pivot.max = facts.bounds.max - facts.pivot;
    for (std::uint32_t i = 0; i < range.size(); ++i) {
        Member& member = members[i];
        member.instance = range.begin + i;
        const glm::dmat4& transform = scene.instances[member.instance].transform;
        const glm::dmat3 linear(transform);
        member.at = linear * facts.pivot + glm::dvec3(transform[3]);
        member.area = instanceArea(facts, linear);
        member.room =
            roomOf(linear, about_pivot, member.at - scene_bounds.min, scene_bounds.max - member.at);
        places.push_back(member.at);
        spots.add(member.at);
    }
    Crowd crowd{{}, spots};
    crowd.members.reserve(members.size());
    for (const std::uint32_t index : mortonOrder(places))
        crowd.members.push_back(members[index]);
    return crowd;
}

// Mean size of the instances: their submesh's radius about the pivot, world units.
double meanRadius(const SubmeshFacts& facts, const std::vector<Member>& members) {
    double area = 0.0;
    for (const Member& member : members)
        area += member.area;
    const double scale2 = area / (facts.area * static_cast<double>(members.size()));
    return 0.5 * facts.bounds.diagonal() * std::sqrt(scale2);
}

} // namespace

bool isCrowd(std::uint32_t instances, std::size_t instances_in_all) {
    return instances >= 1000 || std::size_t{20} * instances >= instances_in_all;
}

void putOff(RemovalSequence& removal) {
    constexpr double kBeyond = 1e150; // no scene's collapses cost as much
    constexpr double kFree = 1e-50;   // what costs nothing is put off as well
    for (double& cost : removal.cost)
        cost = (cost + kFree) * kBeyond;
}

double growthAt(const RemovalSequence& removal, std::uint32_t kept) {
    const std::size_t gone = removal.area_left.size() - 1 - kept;
    return gone == 0 || kept == 0 ? 1.0 : static_cast<double>(removal.growth[gone - 1]);
}

namespace {

// Of the first half to go.
double meanOfFirstHalf(std::span<const double> distances) {
    const std::size_t begin = (distances.size() + 1) / 2;
    double sum = 0.0;
    for (std::size_t i = begin; i < distances.size(); ++i)
        sum += distances[i];
    return sum / static_cast<double>(distances.size() - begin);
}

// [instances] To what growth the removal of order[i] may lead, if it was less before. Unlike sizes:
// the largest must not swell by more than the place of what goes, to make up for dwarfs. Neither
// rising nor falling along the order.
std::vector<double> growthLimits(std::span<const double> areas,
                                 std::span<const double> distances,
                                 double mean_area,
                                 double mean_radius) {
    std::vector<double> limits(areas.size(), kMaxGrowth);
    const auto [least, most] = std::ranges::minmax(areas);
    if (!differInSize(least, most))
        return limits;
    double largest = 0.0;
    for (std::size_t i = 1; i < areas.size(); ++i) {
        largest = std::max(largest, areas[i - 1]);
        const double radius = mean_radius * std::sqrt(largest / mean_area);
        limits[i] = std::min(kMaxGrowth, 1.0 + distances[i] / radius);
    }
    return limits;
}

std::vector<double> runningMaxima(std::vector<double> values) {
    for (std::size_t i = 1; i < values.size(); ++i)
        values[i] = std::max(values[i], values[i - 1]);
    return values;
}

// Pools adjacent violators: each value becomes the mean of its run, runs rise.
std::vector<double> risingMeans(std::span<const double> values) {
    struct Run {
        double sum = 0.0;
        std::size_t count = 0;

        double mean() const { return sum / static_cast<double>(count); }
    };

    std::vector<Run> runs;
    for (const double value : values) {
        Run run{value, 1};
        while (!runs.empty() && runs.back().mean() >= run.mean()) {
            run.sum += runs.back().sum;
            run.count += runs.back().count;
            runs.pop_back();
        }
        runs.push_back(run);
    }
    std::vector<double> means;
    means.reserve(values.size());
    for (const Run& run : runs)
        means.insert(means.end(), run.count, run.mean());
    return means;
}

// Costs, errors and growth from the first removal to the last. A cover makes all removals cheaper
// alike: the first costs what the cover hides, the last ones of a kind stay dear. Of a few of a
// kind each counts, whatever hides it.
void weighRemovals(RemovalSequence& removal,
                   std::span<const double> areas,     // [instances] the longest-lived first
                   std::span<const double> distances, // [instances] to the nearest that outlives
                   const Cover& cover,
                   double radius,  // mean size
                   double reach) { // how far growing may move a surface
    const double apart = meanOfFirstHalf(distances);
    const double one_of = 1.0 / std::sqrt(static_cast<double>(areas.size()));
    const double hidden =
        apart > cover.cost_distance ? std::max(cover.cost_distance / apart, one_of) : 1.0;
    const double bounded = std::min(kMaxGrowth, 1.0 + cover.distance / radius);
    const double all = removal.area_left.back();
    const std::vector<double> limits =
        growthLimits(areas, distances, all / static_cast<double>(areas.size()), radius);
    const bool unlike = differInSize(std::ranges::min(areas), std::ranges::max(areas));
    std::vector<double> costs;
    double to_sisters = 0.0;
    double growth = 1.0;
    for (std::size_t i = areas.size(); i-- > 1;) {
        to_sisters = std::max(to_sisters, distances[i]);
        const double distance = hidden * (unlike ? distances[i] : to_sisters);
        costs.push_back(areas[i] * distance * distance);
        const double limit = std::min(
            {limits[i], 1.0 + reach / radius, to_sisters <= cover.distance ? kMaxGrowth : bounded});
        const double left = removal.area_left[i];
        growth = std::max(growth, left > 0.0 ? std::min(limit, std::sqrt(all / left)) : 1.0);
        removal.error.push_back(static_cast<float>(std::min(to_sisters, cover.distance)));
        removal.growth.push_back(static_cast<float>(growth));
    }
    removal.cost = unlike ? risingMeans(costs) : runningMaxima(costs);
}

} // namespace

RemovalSequence planRemoval(const Scene& scene,
                            InstanceRange range,
                            const SubmeshFacts& facts,
                            const Bounds& scene_bounds,
                            const Cover& cover) {
    const Submesh& submesh = scene.submeshes[scene.instances[range.begin].submesh];
    if (triangleCount(submesh) == 0) // points and lines gain nothing by going
        return {};
    const auto [members, spots] = crowdOf(scene, range, facts, scene_bounds);
    std::vector<std::uint32_t> order = removalOrder(members, spots);
    std::ranges::reverse(order); // the longest-lived first
    RemovalSequence removal;
    removal.pivot = facts.pivot;
    removal.area_left.reserve(order.size() + 1);
    removal.area_left.push_back(0.0);
    auto instances = std::make_shared<std::vector<std::uint32_t>>();
    instances->reserve(order.size());
    std::vector<double> areas;
    std::vector<glm::dvec3> places;
    for (const std::uint32_t index : order) {
        const Member& member = members[index];
        instances->push_back(member.instance);
        removal.area_left.push_back(removal.area_left.back() + member.area);
        areas.push_back(member.area);
        places.push_back(member.at);
    }
    const std::vector<double> distances = distancesToEarlier(places, spots);
    weighRemovals(removal,
                  areas,
                  distances,
                  cover,
                  meanRadius(facts, members),
                  kGrowthReach * scene_bounds.diagonal());
    removal.order = std::move(instances);
    return removal;
}

} // namespace lodestone
