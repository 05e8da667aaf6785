#include "simplify/bake/texture_choice.h"

#include "simplify/measure/srgb.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

struct WeighedErrors {
    double area = 0.0;
    TextureErrors errors; // sums over the points
};

glm::dvec4 codedOf(const glm::vec4& linear) {
    return {srgbFromLinear(static_cast<double>(linear.x)),
            srgbFromLinear(static_cast<double>(linear.y)),
            srgbFromLinear(static_cast<double>(linear.z)),
            static_cast<double>(linear.w)};
}

// Bilinear between texel centres; at: in texels, inside the triangle's place.
glm::dvec4 atlasColor(const BakedPixels& pixels, std::uint32_t size_px, const glm::dvec2& at) {
    const glm::dvec2 low = glm::floor(at - 0.5);
    const glm::dvec2 share = at - 0.5 - low;
    glm::dvec4 color(0.0);
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const auto clamped = [&](double texel) {
                return static_cast<std::size_t>(std::clamp(texel, 0.0, size_px - 1.0));
            };
            const std::uint8_t* const texel =
                &pixels.base_color[4 * (clamped(low.y + j) * size_px + clamped(low.x + i))];
            const double weight =
                (i == 0 ? 1.0 - share.x : share.x) * (j == 0 ? 1.0 - share.y : share.y);
            color += weight * glm::dvec4(texel[0], texel[1], texel[2], texel[3]) / 255.0;
        }
    return color;
}

WeighedErrors errorsOf(const BakedGroup& group,
                       std::size_t index,
                       const BakedPixels& pixels,
                       const BakeSource& source,
                       const TextureSampler& sampler) {
    constexpr int kPerSide = 4;
    const BakedTriangle& triangle = group.triangles[index];
    const Geometry& geometry = *source.primitives[triangle.primitive];
    const std::uint32_t material = source.submesh->primitives[triangle.primitive].material;
    const std::uint32_t* const corner = &geometry.indices[std::size_t{3} * triangle.face];
    const bool alpha_shows = group.material.alpha_mode != AlphaMode::Opaque;
    const auto apart = [&](const glm::dvec4& a, const glm::dvec4& b) {
        return glm::length(glm::dvec3(a - b)) + (alpha_shows ? std::abs(a.w - b.w) : 0.0);
    };
    const TracedTriangle traced(source, triangle);
    WeighedErrors weighed;
    weighed.area =
        source.stretch * source.stretch * static_cast<double>(glm::length(traced.normal()));
    for (int i = 0; i < kPerSide; ++i)
        for (int j = 0; i + j < kPerSide; ++j) {
            const double u = (i + 1.0 / 3.0) / kPerSide;
            const double v = (j + 1.0 / 3.0) / kPerSide;
            const glm::vec3 weights = weightsOf(triangle, u, v);
            const glm::dvec4 right = codedOf(traced.lookAt(weights, sampler).base_color);
            const SurfaceLook kept =
                sampler.at(geometry, material, {corner[0], corner[1], corner[2]}, weights);
            weighed.errors.kept += apart(codedOf(kept.base_color), right);
            weighed.errors.baked += apart(
                atlasColor(pixels, group.atlas.size_px, group.atlas.places[index].at(u, v)), right);
        }
    return weighed;
}

} // namespace

TextureErrors textureErrors(const BakedGroup& group,
                            const BakedPixels& pixels,
                            std::span<const BakeSource> sources,
                            const TextureSampler& sampler) {
    constexpr std::size_t kMostTriangles = 2'000; // 20,000 points: the mean is right to a percent
    const std::size_t stride = group.triangles.size() / kMostTriangles + 1;
    std::vector<WeighedErrors> all((group.triangles.size() + stride - 1) / stride);
    tbb::parallel_for(std::size_t{0}, all.size(), [&](std::size_t i) {
        const BakeSource& source = sources[group.triangles[i * stride].submesh];
        all[i] = errorsOf(group, i * stride, pixels, source, sampler);
    });
    double area = 0.0;
    TextureErrors mean;
    for (const WeighedErrors& one : all) {
        area += 10.0 * one.area;
        mean.kept += one.area * one.errors.kept;
        mean.baked += one.area * one.errors.baked;
    }
    if (!(area > 0.0))
        return {};
    return {mean.kept / area, mean.baked / area};
}

} // namespace lodestone
