#pragma once
#include <glm/glm.hpp>

namespace lodestone {

struct Box {
    glm::vec3 low{0.0f};
    glm::vec3 high{0.0f};

    float squaredDistance(const glm::vec3& p) const { // 0 inside
        const glm::vec3 apart = glm::max(glm::max(low - p, p - high), glm::vec3(0.0f));
        return glm::dot(apart, apart);
    }
};

} // namespace lodestone
