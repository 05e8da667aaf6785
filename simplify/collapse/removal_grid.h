#pragma once
// Distance of each newcomer to the nearest point that is already there.
#include "scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone {

// A dense grid over known bounds that is rebuilt finer whenever the number of points has doubled,
// so that a cell of a full cloud holds about one. Single precision inside the bounds.
class GrowingGrid {
public:
    explicit GrowingGrid(const Bounds& bounds)
        : origin_(bounds.min), longest_(std::max({bounds.size().x,
                                                  bounds.size().y,
                                                  bounds.size().z,
                                                  std::numeric_limits<double>::min()})),
          size_(bounds.size() / longest_) {
        rebuild();
    }

    // Distance from p to the nearest point so far, infinite if there is none; then p is one, too.
    double addAndMeasure(const glm::dvec3& p) {
        const glm::vec3 local((p - origin_) / longest_);
        const double distance = static_cast<double>(nearest(local)) * longest_;
        add(local);
        return distance;
    }

private:
    struct Point {
        glm::vec3 at;
        std::uint32_t next; // in the same cell
    };

    float nearest(const glm::vec3& p) const {
        const glm::vec3 at = p / cell_;
        const glm::ivec3 center = glm::clamp(glm::ivec3(at), glm::ivec3(0), cells_ - 1);
        // The cells that share the corner nearest to p are all that a ball of half a cell touches.
        float best2 = std::numeric_limits<float>::infinity();
        const glm::ivec3 side(glm::lessThan(at - glm::vec3(center), glm::vec3(0.5f)));
        visit(glm::max(center - side, glm::ivec3(0)),
              glm::min(center + 1 - side, cells_ - 1),
              p,
              best2);
        float reach = 0.5f * cell_;
        const int rings = std::max({cells_.x, cells_.y, cells_.z});
        for (int ring = 1; best2 > reach * reach && ring < rings; ring = 2 * ring + 1) {
            visit(glm::max(center - ring, glm::ivec3(0)),
                  glm::min(center + ring, cells_ - 1),
                  p,
                  best2);
            reach = static_cast<float>(ring) * cell_;
        }
        return std::sqrt(best2);
    }

    void add(const glm::vec3& p) {
        points_.push_back({p, kNone});
        if (points_.size() >= 2 * built_for_)
            rebuild();
        else
            insert(static_cast<std::uint32_t>(points_.size() - 1));
    }

    std::size_t indexOf(int x, int y, int z) const {
        const auto wide = [](int i) { return static_cast<std::size_t>(i); };
        return (wide(z) * wide(cells_.y) + wide(y)) * wide(cells_.x) + wide(x);
    }

    void
    visit(const glm::ivec3& low, const glm::ivec3& high, const glm::vec3& p, float& best2) const {
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) {
                const std::uint32_t* head = heads_.data() + indexOf(low.x, y, z);
                const std::uint32_t* const end = head + (high.x - low.x + 1);
                for (; head != end; ++head)
                    for (std::uint32_t id = *head; id != kNone; id = points_[id].next) {
                        const glm::vec3 apart = points_[id].at - p;
                        best2 = std::min(best2, glm::dot(apart, apart));
                    }
            }
    }

    void insert(std::uint32_t id) {
        const glm::ivec3 cell =
            glm::clamp(glm::ivec3(points_[id].at / cell_), glm::ivec3(0), cells_ - 1);
        std::uint32_t& head = heads_[indexOf(cell.x, cell.y, cell.z)];
        points_[id].next = head;
        head = id;
    }

    void rebuild() {
        built_for_ = std::max<std::size_t>(points_.size(), 8);
        // Flat and long clouds use their cells as well as round ones.
        double cell = 1.0 / static_cast<double>(built_for_);
        const auto along = [&](double length) { return std::floor(length / cell) + 1.0; };
        const auto count = [&] { return along(size_.x) * along(size_.y) * along(size_.z); };
        while (count() > static_cast<double>(built_for_))
            cell *= 1.25;
        cell_ = static_cast<float>(cell);
        cells_ = glm::ivec3(along(size_.x), along(size_.y), along(size_.z));
        heads_.assign(static_cast<std::size_t>(count()), kNone);
        for (std::uint32_t id = 0; id < points_.size(); ++id)
            insert(id);
    }

    glm::dvec3 origin_;
    double longest_;
    glm::dvec3 size_; // of the bounds, over longest_
    float cell_ = 1.0f;
    glm::ivec3 cells_{1};
    std::size_t built_for_ = 8;
    std::vector<Point> points_;
    std::vector<std::uint32_t> heads_; // [cells] first point
};

} // namespace lodestone
