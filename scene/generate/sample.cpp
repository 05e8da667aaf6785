#include "scene/generate/sample.h"

#include <cmath>

namespace lodestone::generate {

namespace {

// Cubic through the sRGB curve, within 0.003 of it; exact arithmetic only.
double linearFrom(std::uint32_t srgb_byte) {
    const double s = static_cast<double>(srgb_byte) / 255.0;
    return s * (s * (s * 0.305306011 + 0.682171111) + 0.012522878);
}

} // namespace

glm::dquat upright(const glm::dvec3& up, const glm::dvec3& forward) {
    const glm::dvec3 y = glm::normalize(up);
    glm::dvec3 side = glm::cross(y, forward);
    if (glm::dot(side, side) < 1e-12)
        side = std::abs(y.x) < 0.7 ? glm::cross(y, glm::dvec3(1, 0, 0))
                                   : glm::cross(y, glm::dvec3(0, 0, 1));
    const glm::dvec3 x = glm::normalize(side);
    return glm::normalize(glm::quat_cast(glm::dmat3(x, y, glm::cross(x, y))));
}

glm::dquat yaw(double angle) {
    return {cosine(angle / 2.0), 0.0, sine(angle / 2.0), 0.0};
}

std::uint32_t
Sample::add(const std::string& name, const Mesh& mesh, double crease_angle, const Look& look) {
    Material material;
    material.name = name;
    material.base_color = glm::vec4(static_cast<float>(linearFrom(look.srgb >> 16 & 0xFF)),
                                    static_cast<float>(linearFrom(look.srgb >> 8 & 0xFF)),
                                    static_cast<float>(linearFrom(look.srgb & 0xFF)),
                                    1.0f);
    material.metallic = 0.0f;
    material.roughness = static_cast<float>(look.roughness);
    material.double_sided = look.double_sided;
    Primitive primitive;
    primitive.geometry = makeGeometry(mesh, crease_angle);
    primitive.material = builder_.addMaterial(std::move(material));
    names_.push_back(name);
    triangles_.push_back(mesh.triangleCount());
    placed_.push_back(0);
    return builder_.addSubmesh({name, {std::move(primitive)}});
}

std::uint32_t Sample::addGroup(const std::string& name) {
    return builder_.addNode(name);
}

void Sample::place(std::uint32_t submesh, const Trs& trs, std::uint32_t group) {
    const std::string number = std::to_string(++placed_[submesh]);
    builder_.addNode(names_[submesh] + " #" + number, group, trs, submesh);
    ++instance_count_;
    triangle_count_ += triangles_[submesh];
}

} // namespace lodestone::generate
