#include "simplify/bake/baked_group.h"

#include "simplify/bake/closest_point.h"
#include "simplify/measure/srgb.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

FlatTriangle flatten(const std::array<glm::vec3, 3>& corners, std::array<std::uint8_t, 3>& order) {
    std::size_t longest = 0;
    const auto side = [&](std::size_t k) {
        return glm::length(glm::dvec3(corners[(k + 1) % 3]) - glm::dvec3(corners[k]));
    };
    for (std::size_t k = 1; k < 3; ++k)
        if (side(k) > side(longest))
            longest = k;
    std::size_t right = longest;
    std::size_t end = (longest + 1) % 3;
    const std::size_t third = (longest + 2) % 3;
    const auto gap = [&](std::size_t k) { return glm::length(corners[k] - corners[third]); };
    if (gap(end) < gap(right)) // the shear is smaller from there
        std::swap(right, end);
    order = {static_cast<std::uint8_t>(right),
             static_cast<std::uint8_t>(end),
             static_cast<std::uint8_t>(third)};
    const double base = side(longest);
    const double area2 = glm::length(
        glm::cross(glm::dvec3(corners[1] - corners[0]), glm::dvec3(corners[2] - corners[0])));
    return {base, base > 0.0 ? area2 / base : 0.0};
}

namespace {

glm::vec3 unitOr(const glm::vec3& v, const glm::vec3& fallback) {
    const float length = glm::length(v);
    return length > 1e-20f ? v / length : fallback;
}

std::array<glm::vec3, 3> cornersOf(const BakeSource& source, const BakedTriangle& triangle) {
    return source.map->triangle(source.map->facesOf(triangle.primitive)[triangle.face]);
}

std::uint8_t byteOf(double value) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0));
}

// Some unit vector across another.
glm::vec3 across(const glm::vec3& n) {
    return glm::normalize(std::abs(n.x) < 0.9f ? glm::cross(n, glm::vec3(1.0f, 0.0f, 0.0f))
                                               : glm::cross(n, glm::vec3(0.0f, 1.0f, 0.0f)));
}

} // namespace

glm::vec3 weightsOf(const BakedTriangle& triangle, double along_base, double along_height) {
    glm::vec3 weights;
    weights[triangle.order[0]] = static_cast<float>(1.0 - along_base - along_height);
    weights[triangle.order[1]] = static_cast<float>(along_base);
    weights[triangle.order[2]] = static_cast<float>(along_height);
    return weights;
}

TracedTriangle::TracedTriangle(const BakeSource& source, const BakedTriangle& triangle)
    : source_(source), face_(source.map->facesOf(triangle.primitive)[triangle.face]),
      corners_(source.map->triangle(face_)),
      normal_(glm::cross(corners_[1] - corners_[0], corners_[2] - corners_[0])) {}

SurfaceLook TracedTriangle::lookAt(const glm::vec3& weights, const TextureSampler& sampler) const {
    const Complex& complex = source_.sequence->complex;
    const glm::vec3 point = blended(corners_, weights);
    const SuccessiveMap::Hit hit = source_.map->trace(face_, point, normal_);
    const Primitive& primitive = source_.submesh->primitives[complex.primitiveOfFace(hit.face)];
    std::array<std::uint32_t, 3> vertices;
    for (std::size_t k = 0; k < 3; ++k)
        vertices[k] = complex.wedge_source[complex.faces[hit.face][k]];
    return sampler.at(*primitive.geometry, primitive.material, vertices, hit.weights);
}

TriangleFrame frameOf(const BakeSource& source, const BakedTriangle& triangle, bool turned) {
    const auto corners = cornersOf(source, triangle);
    const glm::vec3 flat =
        unitOr(glm::cross(corners[1] - corners[0], corners[2] - corners[0]), {0.0f, 0.0f, 1.0f});
    const auto [right, end, third] = triangle.order;
    // u grows along the base and v along the height, unless the place is turned by 180 degrees.
    const float sign = turned ? -1.0f : 1.0f;
    const glm::vec3 along = (corners[end] - corners[right]) * sign;
    const glm::vec3 up = (corners[right] - corners[third]) * sign; // against v
    const Geometry& geometry = *source.primitives[triangle.primitive];
    const Attribute* normals = findAttribute(geometry.attributes, "NORMAL");
    TriangleFrame frame;
    for (std::size_t k = 0; k < 3; ++k) {
        glm::vec3& normal = frame.normals[k];
        normal = flat;
        if (normals) {
            const std::uint32_t vertex = geometry.indices[std::size_t{3} * triangle.face + k];
            for (int c = 0; c < 3; ++c)
                normal[c] = attributeValue(*normals, vertex, static_cast<std::size_t>(c));
            normal = unitOr(normal, flat);
        }
        const glm::vec3 tangent = unitOr(along - normal * glm::dot(normal, along), across(normal));
        const float hand = glm::dot(glm::cross(normal, tangent), up) < 0.0f ? -1.0f : 1.0f;
        frame.tangents[k] = glm::vec4(tangent, hand);
    }
    return frame;
}

std::array<glm::vec2, 3> coordinatesOf(const BakedGroup& group, std::size_t triangle) {
    const AtlasPlace& place = group.atlas.places[triangle];
    const auto [right, end, third] = group.triangles[triangle].order;
    const double size = group.atlas.size_px;
    std::array<glm::vec2, 3> uv;
    uv[right] = glm::vec2(place.at(0.0, 0.0) / size);
    uv[end] = glm::vec2(place.at(1.0, 0.0) / size);
    uv[third] = glm::vec2(place.at(0.0, 1.0) / size);
    return uv;
}

namespace {

struct PixelWriter {
    const BakedGroup& group;
    const TextureSampler& sampler;
    BakedPixels& pixels;

    static void put(std::vector<std::uint8_t>& to, std::size_t at, const glm::vec4& value) {
        for (int c = 0; c < 4; ++c)
            to[at + static_cast<std::size_t>(c)] = byteOf(static_cast<double>(value[c]));
    }

    static glm::vec4 coded(const glm::vec3& linear, float alpha) {
        return {srgbFromLinear(static_cast<double>(linear.x)),
                srgbFromLinear(static_cast<double>(linear.y)),
                srgbFromLinear(static_cast<double>(linear.z)),
                alpha};
    }

    void write(std::size_t at, const SurfaceLook& look, const glm::vec3& normal) const {
        put(pixels.base_color, at, coded(glm::vec3(look.base_color), look.base_color.a));
        if (group.normals)
            put(pixels.normal, at, glm::vec4(normal * 0.5f + 0.5f, 1.0f));
        if (group.surface)
            put(pixels.surface, at, {look.occlusion, look.roughness, look.metallic, 1.0f});
        if (group.emission)
            put(pixels.emissive, at, coded(look.emissive, 1.0f));
    }
};

// A direction in the frame that shading will interpolate at that point.
glm::vec3
inFrame(const TriangleFrame& frame, const glm::vec3& weights, const glm::vec3& direction) {
    glm::vec3 normal(0.0f);
    glm::vec3 tangent(0.0f);
    for (int k = 0; k < 3; ++k) {
        normal += frame.normals[static_cast<std::size_t>(k)] * weights[k];
        tangent += glm::vec3(frame.tangents[static_cast<std::size_t>(k)]) * weights[k];
    }
    normal = unitOr(normal, frame.normals[0]);
    tangent = unitOr(tangent - normal * glm::dot(normal, tangent), across(normal));
    const glm::vec3 bitangent = glm::cross(normal, tangent) * frame.tangents[0].w;
    const glm::vec3 local(glm::dot(direction, tangent),
                          glm::dot(direction, bitangent),
                          std::max(glm::dot(direction, normal), 0.0f)); // never from below
    return unitOr(local, {0.0f, 0.0f, 1.0f});
}

bool bakeTriangle(const BakedGroup& group,
                  std::size_t index,
                  const BakeSource& source,
                  const PixelWriter& writer,
                  const std::function<bool(std::size_t)>& done) {
    const BakedTriangle& triangle = group.triangles[index];
    const AtlasPlace& place = group.atlas.places[index];
    const TracedTriangle traced(source, triangle);
    const TriangleFrame frame = frameOf(source, triangle, place.turned);
    std::size_t texels = 0;
    bool goes_on = true;
    forEachTexel(place, [&](std::uint32_t x, std::uint32_t y, double u, double v) {
        if (++texels % 512 == 0)
            goes_on = goes_on && done(0);
        if (!goes_on)
            return;
        const glm::vec3 weights = weightsOf(triangle, u, v);
        const SurfaceLook look = traced.lookAt(weights, writer.sampler);
        const std::size_t at = 4 * (std::size_t{y} * group.atlas.size_px + x);
        writer.write(
            at, look, group.normals ? inFrame(frame, weights, look.normal) : traced.normal());
    });
    return goes_on && done(1);
}

// Texels that nothing was written to take on the colours beside them, a few texels wide, so that
// smaller sizes of the texture and JPEG's blocks show little else. Marks them as used.
void spreadColors(std::vector<std::uint8_t>& rgba, std::vector<bool>& used, std::size_t side) {
    constexpr int kReach = 4; // half of what lies between triangles, and more
    for (int pass = 0; pass < kReach; ++pass) {
        std::vector<std::size_t> fresh;
        for (std::size_t at = 0; at < used.size(); ++at) {
            if (used[at])
                continue;
            const std::size_t x = at % side;
            const std::array<std::pair<bool, std::size_t>, 4> beside{
                std::pair{x > 0, at - 1},
                {x + 1 < side, at + 1},
                {at >= side, at - side},
                {at + side < used.size(), at + side}};
            std::array<unsigned, 4> sum{};
            unsigned count = 0;
            for (const auto& [inside, other] : beside)
                if (inside && used[other]) {
                    ++count;
                    for (std::size_t c = 0; c < 4; ++c)
                        sum[c] += rgba[4 * other + c];
                }
            if (count == 0)
                continue;
            for (std::size_t c = 0; c < 4; ++c)
                rgba[4 * at + c] = static_cast<std::uint8_t>(sum[c] / count);
            fresh.push_back(at);
        }
        for (const std::size_t at : fresh)
            used[at] = true;
    }
}

// Texels that nothing was written to get one colour.
void fillUnused(std::vector<std::uint8_t>& rgba,
                const std::vector<bool>& used,
                const std::optional<std::array<std::uint8_t, 3>>& color) {
    std::array<std::uint64_t, 3> sum{};
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < used.size(); ++i) {
        if (!used[i])
            continue;
        ++count;
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += rgba[4 * i + c];
    }
    std::array<std::uint8_t, 4> fill{0, 0, 0, 255};
    for (std::size_t c = 0; c < 3; ++c)
        fill[c] = color ? (*color)[c] : static_cast<std::uint8_t>(count > 0 ? sum[c] / count : 0);
    for (std::size_t i = 0; i < used.size(); ++i)
        if (!used[i])
            std::ranges::copy(fill, rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
}

} // namespace

Result<BakedPixels> bakePixels(const BakedGroup& group,
                               std::span<const BakeSource> sources,
                               const TextureSampler& sampler,
                               const BakeOptions& options,
                               const std::function<bool(std::size_t)>& done) {
    const std::size_t texels = std::size_t{group.atlas.size_px} * group.atlas.size_px;
    BakedPixels pixels;
    pixels.base_color.resize(4 * texels);
    pixels.normal.resize(group.normals ? 4 * texels : 0);
    pixels.surface.resize(group.surface ? 4 * texels : 0);
    pixels.emissive.resize(group.emission ? 4 * texels : 0);
    const PixelWriter writer{group, sampler, pixels};
    std::atomic<bool> stopped{false};
    tbb::parallel_for(std::size_t{0}, group.triangles.size(), [&](std::size_t i) {
        if (!stopped && !bakeTriangle(group, i, sources[group.triangles[i].submesh], writer, done))
            stopped = true;
    });
    if (stopped)
        return cancelled();
    std::vector<bool> used(texels);
    for (const AtlasPlace& place : group.atlas.places)
        forEachTexel(place, [&](std::uint32_t x, std::uint32_t y, double, double) {
            used[std::size_t{y} * group.atlas.size_px + x] = true;
        });
    for (std::vector<std::uint8_t>* image :
         {&pixels.base_color, &pixels.normal, &pixels.surface, &pixels.emissive})
        if (!image->empty()) {
            std::vector<bool> filled = used;
            if (!options.unused)
                spreadColors(*image, filled, group.atlas.size_px);
            fillUnused(*image, filled, options.unused);
        }
    return pixels;
}

} // namespace lodestone
