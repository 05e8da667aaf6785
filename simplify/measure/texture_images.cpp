#include "simplify/measure/texture_images.h"

#include "simplify/measure/srgb.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// Texel number of any integer position along an axis of `size` texels.
std::int64_t wrapped(std::int64_t at, std::int64_t size, TextureWrap wrap) {
    if (wrap == TextureWrap::ClampToEdge)
        return std::clamp<std::int64_t>(at, 0, size - 1);
    const std::int64_t period = wrap == TextureWrap::MirroredRepeat ? 2 * size : size;
    const std::int64_t in_period = ((at % period) + period) % period;
    return in_period < size ? in_period : period - 1 - in_period;
}

float linearByte(unsigned char byte) {
    static const std::array<float, 256> kTable = [] {
        std::array<float, 256> values{};
        for (std::size_t b = 0; b < values.size(); ++b)
            values[b] = static_cast<float>(linearFromSrgb(static_cast<double>(b) / 255.0));
        return values;
    }();
    return kTable[byte];
}

// Null where there are none.
const Attribute* coordinatesOf(const Geometry& geometry, const TextureRef& texture) {
    const Attribute* uv =
        findAttribute(geometry.attributes, "TEXCOORD_" + std::to_string(texture.texcoord));
    return uv && uv->components == 2 ? uv : nullptr;
}

} // namespace

glm::vec4 blendAttribute(const Attribute& attribute,
                         const std::array<std::uint32_t, 3>& corners,
                         const glm::vec3& weights,
                         const glm::vec4& fallback) {
    glm::vec4 value = fallback;
    for (int c = 0; c < std::min<int>(4, attribute.components); ++c) {
        value[c] = 0.0f;
        for (int k = 0; k < 3; ++k)
            value[c] += weights[k] * attributeValue(attribute,
                                                    corners[static_cast<std::size_t>(k)],
                                                    static_cast<std::size_t>(c));
    }
    return value;
}

glm::vec4 vertexColorAt(const Geometry& geometry,
                        const std::array<std::uint32_t, 3>& corners,
                        const glm::vec3& weights) {
    const glm::vec4 white(1.0f);
    const Attribute* color = findAttribute(geometry.attributes, "COLOR_0");
    return color && color->components >= 3 ? blendAttribute(*color, corners, weights, white)
                                           : white;
}

TextureImages::TextureImages(const Scene& scene, std::span<const Slot> slots)
    : images_(scene.images.size()) {
    std::vector<bool> used(images_.size());
    for (const Material& material : scene.materials)
        for (const Slot slot : slots)
            if (const std::uint32_t image = (material.*slot).image; image < used.size())
                used[image] = true;
    tbb::parallel_for(std::size_t{0}, images_.size(), [&](std::size_t i) {
        if (used[i])
            images_[i] = decodeImage(scene.images[i], std::numeric_limits<int>::max());
    });
    for (std::uint32_t i = 0; i < images_.size(); ++i)
        if (used[i] && !images_[i].rgba)
            notes_.push_back(scene.name + ": " + imageLabel(scene, i) + " " + images_[i].fault +
                             ": it counts as white; use PNG, JPEG or WebP");
}

bool TextureImages::covers(const Geometry& geometry, const TextureRef& texture) const {
    return texture.image < images_.size() && images_[texture.image].rgba &&
           coordinatesOf(geometry, texture);
}

glm::ivec2 TextureImages::size(std::uint32_t image) const {
    if (image >= images_.size() || !images_[image].rgba)
        return {0, 0};
    return {images_[image].width, images_[image].height};
}

glm::vec4 TextureImages::sample(const Geometry& geometry,
                                const TextureRef& texture,
                                const std::array<std::uint32_t, 3>& corners,
                                const glm::vec3& weights,
                                Coding coding) const {
    const glm::vec4 white(1.0f);
    if (texture.image >= images_.size() || !images_[texture.image].rgba)
        return white;
    const Attribute* uv = coordinatesOf(geometry, texture);
    if (!uv)
        return white;
    const DecodedImage& image = images_[texture.image];
    const glm::vec4 raw = blendAttribute(*uv, corners, weights, white);
    const glm::vec3 at = texture.uv_transform * glm::vec3(raw.x, raw.y, 1.0f);
    constexpr double kFarTexels = 1e9; // beyond it integers would overflow
    const glm::dvec2 texels =
        glm::clamp(glm::dvec2(at) * glm::dvec2(image.width, image.height), -kFarTexels, kFarTexels);
    const auto texel = [&](std::int64_t x, std::int64_t y) {
        const unsigned char* p =
            image.rgba.get() + 4 * (wrapped(y, image.height, texture.wrap_v) * image.width +
                                    wrapped(x, image.width, texture.wrap_u));
        const float alpha = static_cast<float>(p[3]) / 255.0f;
        if (coding == Coding::Srgb)
            return glm::vec4(linearByte(p[0]), linearByte(p[1]), linearByte(p[2]), alpha);
        return glm::vec4(glm::vec3(p[0], p[1], p[2]) / 255.0f, alpha);
    };
    const glm::dvec2 low = glm::floor(texture.nearest ? texels : texels - 0.5);
    const auto x = static_cast<std::int64_t>(low.x);
    const auto y = static_cast<std::int64_t>(low.y);
    if (texture.nearest)
        return texel(x, y);
    const glm::vec2 share(texels - 0.5 - low);
    return glm::mix(glm::mix(texel(x, y), texel(x + 1, y), share.x),
                    glm::mix(texel(x, y + 1), texel(x + 1, y + 1), share.x),
                    share.y);
}

} // namespace lodestone
