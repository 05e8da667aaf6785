#include "simplify/bake/texel_density.h"

#include <cmath>

namespace lodestone {

double TexelArea::texelsPerUnit() const {
    return area > 0.0 ? std::sqrt(texels / area) : 0.0;
}

void TexelArea::add(const Geometry& geometry,
                    const TextureRef& texture,
                    const glm::dvec2& size_px,
                    double stretch) {
    const Attribute* const uv =
        findAttribute(geometry.attributes, "TEXCOORD_" + std::to_string(texture.texcoord));
    if (uv == nullptr || uv->components != 2)
        return;
    const double scale = size_px.x * size_px.y *
                         std::abs(glm::determinant(glm::dmat2(glm::dmat3(texture.uv_transform))));
    const auto at = [&](std::uint32_t vertex) {
        return glm::dvec2(attributeValue(*uv, vertex, 0), attributeValue(*uv, vertex, 1));
    };
    for (std::size_t i = 0; i + 2 < geometry.indices.size(); i += 3) {
        const std::uint32_t* const corner = &geometry.indices[i];
        const glm::dvec3 origin(geometry.positions[corner[0]]);
        const glm::dvec3 across = glm::cross(glm::dvec3(geometry.positions[corner[1]]) - origin,
                                             glm::dvec3(geometry.positions[corner[2]]) - origin);
        const glm::dvec2 first = at(corner[1]) - at(corner[0]);
        const glm::dvec2 second = at(corner[2]) - at(corner[0]);
        const double covered = 0.5 * std::abs(first.x * second.y - first.y * second.x) * scale;
        if (!std::isfinite(covered))
            continue;
        texels += covered;
        area += 0.5 * glm::length(across) * stretch * stretch;
    }
}

} // namespace lodestone
