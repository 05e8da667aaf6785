#include "simplify/collapse/removal_grid.h"

#include "simplify/collapse/quadric.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone {

namespace {

// A dense grid over the first `count` points that is filled with them one by one. What a cell will
// hold lies together and next to what its neighbours along x will; places still free are infinitely
// far off. So a row of cells is one stretch of memory, looked at four points at a time.
class FillingGrid {
public:
    // size: of the points' bounds, which begin at 0, at most 1 along each axis.
    FillingGrid(std::span<const glm::vec3> points, const glm::dvec3& size);

    void add(std::uint32_t point);
    // Distance to the nearest point so far, infinite if there is none.
    float nearest(const glm::vec3& p) const;

private:
    std::size_t indexOf(int x, int y, int z) const {
        const auto wide = [](int i) { return static_cast<std::size_t>(i); };
        return (wide(z) * wide(cells_.y) + wide(y)) * wide(cells_.x) + wide(x);
    }

    glm::ivec3 cellOf(const glm::vec3& p) const {
        return glm::clamp(glm::ivec3(p * per_cell_), glm::ivec3(0), cells_ - 1);
    }

    float nearestWithin(const glm::ivec3& low, const glm::ivec3& high, const glm::vec3& p) const;

    std::span<const glm::vec3> points_;
    float cell_ = 1.0f;
    float per_cell_ = 1.0f;
    glm::ivec3 cells_{1};
    std::vector<std::uint32_t> begin_; // [cells + 1]
    std::vector<std::uint32_t> place_; // [points]
    std::vector<float> x_;             // [places, and three more]
    std::vector<float> y_;
    std::vector<float> z_;
};

FillingGrid::FillingGrid(std::span<const glm::vec3> points, const glm::dvec3& size)
    : points_(points) {
    // Flat and long clouds use their cells as well as round ones.
    constexpr double kPerCell = 3.0; // points, once all are there: the fastest in trials
    const double most = std::max(1.0, static_cast<double>(points.size()) / kPerCell);
    double cell = 1.0 / most;
    const auto along = [&](double length) { return std::floor(length / cell) + 1.0; };
    const auto count = [&] { return along(size.x) * along(size.y) * along(size.z); };
    while (count() > most && most > 1.0)
        cell *= 1.25;
    cell_ = static_cast<float>(cell);
    per_cell_ = 1.0f / cell_;
    cells_ = glm::ivec3(along(size.x), along(size.y), along(size.z));
    begin_.assign(static_cast<std::size_t>(count()) + 2, 0);
    place_.resize(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::ivec3 at = cellOf(points[i]);
        place_[i] = static_cast<std::uint32_t>(indexOf(at.x, at.y, at.z));
        ++begin_[place_[i] + 2];
    }
    for (std::size_t c = 2; c < begin_.size(); ++c)
        begin_[c] += begin_[c - 1];
    for (std::uint32_t& place : place_)
        place = begin_[place + 1]++;
    constexpr float kFar = std::numeric_limits<float>::infinity();
    x_.assign(points.size() + 3, kFar);
    y_.assign(points.size() + 3, kFar);
    z_.assign(points.size() + 3, kFar);
}

void FillingGrid::add(std::uint32_t point) {
    const std::uint32_t place = place_[point];
    x_[place] = points_[point].x;
    y_[place] = points_[point].y;
    z_[place] = points_[point].z;
}

float FillingGrid::nearestWithin(const glm::ivec3& low,
                                 const glm::ivec3& high,
                                 const glm::vec3& p) const {
    const auto all = [](float value) { return Float4{value, value, value, value}; };
    const Vector3<Float4> from{all(p.x), all(p.y), all(p.z)};
    Float4 best = all(std::numeric_limits<float>::infinity());
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y) {
            const std::uint32_t end = begin_[indexOf(high.x, y, z) + 1];
            for (std::uint32_t i = begin_[indexOf(low.x, y, z)]; i < end; i += 4) {
                const Vector3<Float4> at{loadFour(&x_[i]), loadFour(&y_[i]), loadFour(&z_[i])};
                const Vector3<Float4> apart = at - from;
                const Float4 distance2 = dot(apart, apart);
                best = select(distance2 < best, distance2, best);
            }
        }
    return std::min(std::min(best[0], best[1]), std::min(best[2], best[3]));
}

float FillingGrid::nearest(const glm::vec3& p) const {
    const glm::vec3 at = p * per_cell_;
    const glm::ivec3 center = cellOf(p);
    // The cells that share the corner nearest to p are all that a ball of half a cell touches.
    const glm::ivec3 side(glm::lessThan(at - glm::vec3(center), glm::vec3(0.5f)));
    float best2 = nearestWithin(
        glm::max(center - side, glm::ivec3(0)), glm::min(center + 1 - side, cells_ - 1), p);
    float reach = 0.5f * cell_;
    const int rings = std::max({cells_.x, cells_.y, cells_.z});
    for (int ring = 1; best2 > reach * reach && ring < rings; ring = 2 * ring + 1) {
        best2 = nearestWithin(
            glm::max(center - ring, glm::ivec3(0)), glm::min(center + ring, cells_ - 1), p);
        reach = static_cast<float>(ring) * cell_;
    }
    return std::sqrt(best2);
}

} // namespace

std::vector<double> distancesToEarlier(std::span<const glm::dvec3> points, const Bounds& bounds) {
    constexpr std::size_t kFirst = 8; // the grid is made anew whenever there are twice as many
    const double longest = std::max(
        {bounds.size().x, bounds.size().y, bounds.size().z, std::numeric_limits<double>::min()});
    std::vector<glm::vec3> local;
    local.reserve(points.size());
    for (const glm::dvec3& p : points)
        local.emplace_back((p - bounds.min) / longest);
    std::vector<double> distances;
    distances.reserve(points.size());
    while (distances.size() < points.size()) {
        const std::size_t known = distances.size();
        const std::size_t end = std::min(points.size(), std::max(kFirst, 2 * known));
        FillingGrid grid(std::span<const glm::vec3>(local).first(end), bounds.size() / longest);
        for (std::uint32_t i = 0; i < known; ++i)
            grid.add(i);
        for (auto i = static_cast<std::uint32_t>(known); i < end; ++i) {
            distances.push_back(static_cast<double>(grid.nearest(local[i])) * longest);
            grid.add(i);
        }
    }
    return distances;
}

} // namespace lodestone
