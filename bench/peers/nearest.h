#pragma once
// Which of many points is the nearest: a k-d tree.
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace lodestone::bench {

class NearestPoint {
public:
    // points: finite, at least one; must outlive this. O(n log n).
    explicit NearestPoint(std::span<const glm::vec3> points);

    // Index of a nearest point; of several, always the same one. O(log n).
    std::uint32_t operator()(const glm::vec3& point) const;

private:
    struct Best {
        std::uint32_t index = 0;
        float squared_distance = 0.0F;
    };

    void search(const glm::vec3& point, std::span<const std::uint32_t> range, Best& best) const;
    int axisOf(std::span<const std::uint32_t> range) const;

    std::span<const glm::vec3> points_;
    std::vector<std::uint32_t> order_; // [points] every range's middle splits it along its axis
    std::vector<std::uint8_t> axes_;   // [points] of the split at that place
};

} // namespace lodestone::bench
