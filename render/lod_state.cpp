#include "render/lod_state.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

// A colour between those given, for a share 0..1, linear.
glm::vec3 valueColor(const ViewOptions& options, double share) {
    const double last = static_cast<double>(options.value_colors.size() - 1);
    const double place = std::clamp(share, 0.0, 1.0) * last;
    const auto lower = static_cast<std::size_t>(std::min(place, last - 1.0));
    const auto between = static_cast<float>(place - static_cast<double>(lower));
    const glm::vec3 srgb =
        glm::mix(options.value_colors[lower], options.value_colors[lower + 1], between);
    return glm::pow(srgb, glm::vec3(2.2f));
}

} // namespace

glm::vec4 lodStateColor(const DrawItem& item, const Scene& scene, const ViewOptions& options) {
    std::uint64_t full = 0;
    for (const Primitive& primitive : scene.submeshes[item.submesh].primitives) {
        if (primitive.geometry == item.geometry->source)
            return {0.35f, 0.35f, 0.35f, 1.0f};
        full += primitive.geometry->triangleCount();
    }
    const double kept = static_cast<double>(item.geometry->source->triangleCount()) /
                        static_cast<double>(std::max<std::uint64_t>(full, 1));
    return {valueColor(options, -std::log10(std::max(kept, 1e-3)) / 3.0), 1.0f};
}

} // namespace lodestone
