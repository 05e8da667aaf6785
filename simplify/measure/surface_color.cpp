#include "simplify/measure/surface_color.h"

#include "simplify/measure/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// Texel number of any integer position along an axis of `size` texels.
std::uint32_t wrapped(std::int64_t at, std::uint32_t size, TextureWrap wrap) {
    const auto count = std::int64_t{size};
    if (wrap == TextureWrap::ClampToEdge)
        return static_cast<std::uint32_t>(std::clamp<std::int64_t>(at, 0, count - 1));
    const std::int64_t period = wrap == TextureWrap::MirroredRepeat ? 2 * count : count;
    std::int64_t in_period = at % period;
    if (in_period < 0)
        in_period += period;
    return static_cast<std::uint32_t>(in_period < count ? in_period : period - 1 - in_period);
}

const std::array<float, 256>& linearBytes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values{};
        for (std::size_t byte = 0; byte < values.size(); ++byte)
            values[byte] = static_cast<float>(linearFromSrgb(static_cast<double>(byte) / 255.0));
        return values;
    }();
    return table;
}

// An attribute's first `count` components at a point of a triangle.
glm::vec3 attributeAt(const Attribute& attribute,
                      const std::uint32_t* corners,
                      const glm::dvec3& weights,
                      std::size_t count) {
    glm::vec3 value(0.0f);
    for (int corner = 0; corner < 3; ++corner)
        for (std::size_t c = 0; c < count; ++c)
            value[static_cast<int>(c)] +=
                static_cast<float>(weights[corner]) * attributeValue(attribute, corners[corner], c);
    return value;
}

// Linear colour of a decoded image at uv (0,0 top left), bilinear or nearest, wrapped as the
// reference says.
glm::vec3 linearAt(const DecodedImage& image, const glm::vec2& uv, const TextureRef& texture) {
    const auto width = static_cast<std::uint32_t>(image.width);
    const auto height = static_cast<std::uint32_t>(image.height);
    const auto texel = [&](std::int64_t x, std::int64_t y) {
        const std::size_t at =
            std::size_t{4} * (std::size_t{wrapped(y, height, texture.wrap_v)} * width +
                              wrapped(x, width, texture.wrap_u));
        const auto& linear = linearBytes();
        const unsigned char* rgb = image.rgba.get() + at;
        return glm::vec3(linear[rgb[0]], linear[rgb[1]], linear[rgb[2]]);
    };
    // Far outside, float has no fractions left and integers would overflow.
    constexpr double kFarTexels = 1e9;
    const glm::dvec2 size(width, height);
    const glm::dvec2 at = glm::clamp(glm::dvec2(uv) * size, -kFarTexels, kFarTexels);
    if (texture.nearest)
        return texel(static_cast<std::int64_t>(std::floor(at.x)),
                     static_cast<std::int64_t>(std::floor(at.y)));
    const glm::dvec2 low = glm::floor(at - 0.5);
    const glm::vec2 share(at - 0.5 - low);
    const auto x = static_cast<std::int64_t>(low.x);
    const auto y = static_cast<std::int64_t>(low.y);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), share.x),
                    glm::mix(texel(x, y + 1), texel(x + 1, y + 1), share.x),
                    share.y);
}

} // namespace

SurfaceColors::SurfaceColors(const Scene& scene) : scene_(scene), images_(scene.images.size()) {
    std::vector<bool> used(scene.images.size());
    for (const Material& material : scene.materials)
        if (material.base_color_texture.image < used.size())
            used[material.base_color_texture.image] = true;
    tbb::parallel_for(std::size_t{0}, images_.size(), [&](std::size_t i) {
        if (used[i])
            images_[i] = decodeImage(scene.images[i], std::numeric_limits<int>::max());
    });
    for (std::uint32_t i = 0; i < images_.size(); ++i)
        if (used[i] && !images_[i].rgba)
            notes_.push_back(scene.name + ": " + imageLabel(scene, i) + " " + images_[i].fault +
                             ": it counts as white; use PNG, JPEG or WebP");
}

glm::dvec3 SurfaceColors::at(const Geometry& geometry,
                             std::uint32_t material_index,
                             std::size_t triangle,
                             const glm::dvec3& weights) const {
    const std::uint32_t* corners = geometry.indices.data() + 3 * triangle;
    glm::vec3 linear(1.0f);
    if (material_index < scene_.materials.size()) {
        const Material& material = scene_.materials[material_index];
        const TextureRef& texture = material.base_color_texture;
        linear = glm::vec3(material.base_color);
        const Attribute* uv =
            findAttribute(geometry.attributes, "TEXCOORD_" + std::to_string(texture.texcoord));
        if (texture.image < images_.size() && images_[texture.image].rgba && uv &&
            uv->components == 2) {
            glm::vec3 at = attributeAt(*uv, corners, weights, 2);
            at.z = 1.0f;
            linear *=
                linearAt(images_[texture.image], glm::vec2(texture.uv_transform * at), texture);
        }
    }
    const Attribute* color = findAttribute(geometry.attributes, "COLOR_0");
    if (color && color->components >= 3)
        linear *= attributeAt(*color, corners, weights, 3);
    return {srgbFromLinear(linear.x), srgbFromLinear(linear.y), srgbFromLinear(linear.z)};
}

} // namespace lodestone
