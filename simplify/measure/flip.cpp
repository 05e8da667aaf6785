// FLIP for low-dynamic-range pictures (Andersson et al. 2020). Symbols as in the paper.
#include "simplify/measure/image_difference.h"
#include "simplify/measure/plane.h"
#include "simplify/measure/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kQc = 0.7;     // exponent of the colour difference
constexpr double kPc = 0.4;     // share of the largest difference that ...
constexpr double kPt = 0.95;    // ... is mapped to this much of the range
constexpr double kQf = 0.5;     // exponent of the feature difference
constexpr double kEdge = 0.082; // width of a detected edge or point, degrees

// --- colour spaces; D65 white of linear sRGB ---

const glm::dmat3& xyzFromRgb() {
    static const glm::dmat3 matrix = glm::transpose(glm::dmat3(10135552.0 / 24577794,
                                                               8788810.0 / 24577794,
                                                               4435075.0 / 24577794,
                                                               2613072.0 / 12288897,
                                                               8788810.0 / 12288897,
                                                               887015.0 / 12288897,
                                                               1425312.0 / 73733382,
                                                               8788810.0 / 73733382,
                                                               70074185.0 / 73733382));
    return matrix;
}

// XYZ over that of white.
glm::dvec3 relativeXyz(const glm::dvec3& linear_rgb) {
    static const glm::dvec3 white = xyzFromRgb() * glm::dvec3(1.0);
    return (xyzFromRgb() * linear_rgb) / white;
}

// An opponent space that is linear in light, where the eye's blur applies.
glm::dvec3 ycxczFromRgb(const glm::dvec3& linear_rgb) {
    const glm::dvec3 xyz = relativeXyz(linear_rgb);
    return {116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)};
}

glm::dvec3 rgbFromYcxcz(const glm::dvec3& ycxcz) {
    static const glm::dvec3 white = xyzFromRgb() * glm::dvec3(1.0);
    static const glm::dmat3 rgb_from_xyz = glm::inverse(xyzFromRgb());
    const double y = (ycxcz.x + 16.0) / 116.0;
    return rgb_from_xyz * (white * glm::dvec3(y + ycxcz.y / 500.0, y, y - ycxcz.z / 200.0));
}

// CIELab with chroma that fades with lightness (Hunt effect).
glm::dvec3 huntLabFromRgb(const glm::dvec3& linear_rgb) {
    const glm::dvec3 xyz = relativeXyz(linear_rgb);
    const auto f = [](double t) {
        constexpr double kDelta = 6.0 / 29.0;
        return t > kDelta * kDelta * kDelta ? std::cbrt(t)
                                            : t / (3.0 * kDelta * kDelta) + 4.0 / 29.0;
    };
    const double lightness = 116.0 * f(xyz.y) - 16.0;
    return {lightness,
            0.01 * lightness * 500.0 * (f(xyz.x) - f(xyz.y)),
            0.01 * lightness * 200.0 * (f(xyz.y) - f(xyz.z))};
}

double hyab(const glm::dvec3& a, const glm::dvec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// --- what the eye sees of a picture ---

using Channels = std::array<Plane, 3>; // Y, Cx, Cz

Channels channelsOf(const Picture& picture) {
    std::array<double, 256> linear{};
    for (std::size_t byte = 0; byte < linear.size(); ++byte)
        linear[byte] = linearFromSrgb(static_cast<double>(byte) / 255.0);
    Channels channels;
    channels.fill(Plane(picture.width_px, picture.height_px));
    tbb::parallel_for(std::uint32_t{0}, picture.height_px, [&](std::uint32_t y) {
        const std::uint8_t* rgba = picture.rgba.data() + std::size_t{4} * y * picture.width_px;
        for (std::uint32_t x = 0; x < picture.width_px; ++x, rgba += 4) {
            const glm::dvec3 ycxcz =
                ycxczFromRgb({linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]});
            for (int c = 0; c < 3; ++c)
                channels[static_cast<std::size_t>(c)].row(y)[x] = static_cast<float>(ycxcz[c]);
        }
    });
    return channels;
}

// One Gaussian of a contrast sensitivity function: weight a * sqrt(pi / b), spread b in degrees^2.
struct Sensitivity {
    double a = 1.0;
    double b = 0.0047;
};

constexpr double kWidest = 0.04; // the largest b: all filters are cut off at its three sigma

Plane seen(const Plane& plane, std::span<const Sensitivity> terms, double pixels_per_degree) {
    const auto sigma_px = [&](double b) {
        return std::sqrt(b / (2.0 * kPi * kPi)) * pixels_per_degree;
    };
    const int radius_px = static_cast<int>(std::ceil(3.0 * sigma_px(kWidest)));
    std::vector<double> shares; // of the 2D integral over the pixels
    double sum = 0.0;
    for (const Sensitivity& term : terms) {
        double weight_sum = 0.0;
        for (int x = -radius_px; x <= radius_px; ++x)
            weight_sum += std::exp(-0.5 * x * x / (sigma_px(term.b) * sigma_px(term.b)));
        shares.push_back(term.a * std::sqrt(kPi / term.b) * weight_sum * weight_sum);
        sum += shares.back();
    }
    Plane result(plane.width, plane.height);
    for (std::size_t t = 0; t < terms.size(); ++t) {
        const Kernel kernel = gaussianKernel(sigma_px(terms[t].b), radius_px);
        const Plane blurred = filteredAlongY(filteredAlongX(plane, kernel), kernel);
        const auto share = static_cast<float>(shares[t] / sum);
        for (std::size_t i = 0; i < result.values.size(); ++i)
            result.values[i] += share * blurred.values[i];
    }
    return result;
}

Channels seen(const Channels& channels, double pixels_per_degree) {
    static constexpr std::array<Sensitivity, 1> kAchromatic = {{{1.0, 0.0047}}};
    static constexpr std::array<Sensitivity, 1> kRedGreen = {{{1.0, 0.0053}}};
    static constexpr std::array<Sensitivity, 2> kBlueYellow = {{{34.1, kWidest}, {13.5, 0.025}}};
    return {seen(channels[0], kAchromatic, pixels_per_degree),
            seen(channels[1], kRedGreen, pixels_per_degree),
            seen(channels[2], kBlueYellow, pixels_per_degree)};
}

glm::dvec3 labAt(const Channels& channels, std::size_t i) {
    const glm::dvec3 rgb =
        rgbFromYcxcz({channels[0].values[i], channels[1].values[i], channels[2].values[i]});
    return huntLabFromRgb(glm::clamp(rgb, 0.0, 1.0));
}

// --- features ---

// Weights w(x), negative ones summing up to -1 and positive ones to 1.
template <class Weight>
Kernel balancedKernel(int radius_px, const Weight& weight) {
    double positive = 0.0;
    double negative = 0.0;
    for (int x = -radius_px; x <= radius_px; ++x)
        (weight(x) > 0.0 ? positive : negative) += std::abs(weight(x));
    Kernel kernel;
    for (int x = -radius_px; x <= radius_px; ++x)
        kernel.push_back(static_cast<float>(weight(x) / (weight(x) > 0.0 ? positive : negative)));
    return kernel;
}

struct Features {
    Plane edges;  // lengths of the first derivative
    Plane points; // of the second
};

Plane lengths(const Plane& x, const Plane& y) {
    Plane result(x.width, x.height);
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = std::hypot(x.values[i], y.values[i]);
    return result;
}

Features featuresOf(const Plane& luminance, double pixels_per_degree) {
    const double sigma_px = 0.5 * kEdge * pixels_per_degree;
    const int radius_px = static_cast<int>(std::ceil(3.0 * sigma_px));
    const auto bell = [&](int x) { return std::exp(-0.5 * x * x / (sigma_px * sigma_px)); };
    const Kernel blur = gaussianKernel(sigma_px, radius_px);
    const Kernel first = balancedKernel(radius_px, [&](int x) { return -x * bell(x); });
    const Kernel second = balancedKernel(
        radius_px, [&](int x) { return (x * x / (sigma_px * sigma_px) - 1.0) * bell(x); });
    Plane y = luminance;
    for (float& value : y.values)
        value = (value + 16.0f) / 116.0f;
    const Plane blurred_x = filteredAlongX(y, blur);
    const Plane blurred_y = filteredAlongY(y, blur);
    return {lengths(filteredAlongX(blurred_y, first), filteredAlongY(blurred_x, first)),
            lengths(filteredAlongX(blurred_y, second), filteredAlongY(blurred_x, second))};
}

// --- both together ---

// The largest distance between colours of the display, and what is mapped to kPt.
double mappedColorDifference(double difference) {
    static const double largest =
        std::pow(hyab(huntLabFromRgb({0.0, 1.0, 0.0}), huntLabFromRgb({0.0, 0.0, 1.0})), kQc);
    const double knee = kPc * largest;
    const double power = std::pow(difference, kQc);
    return power < knee ? kPt / knee * power
                        : kPt + (power - knee) / (largest - knee) * (1.0 - kPt);
}

struct Seen {
    Channels channels;
    Features features;
};

Seen look(const Picture& picture, double pixels_per_degree) {
    const Channels channels = channelsOf(picture);
    return {seen(channels, pixels_per_degree), featuresOf(channels[0], pixels_per_degree)};
}

} // namespace

Result<std::vector<float>> flipMap(const Picture& reference,
                                   const Picture& test,
                                   const ImageDifferenceOptions& options,
                                   const JobContext& job) {
    if (Result<void> checked = checkPictures(reference, test, options); !checked)
        return tl::unexpected<Error>(std::move(checked.error()));
    if (job.stopRequested())
        return cancelled();
    const Seen a = look(reference, options.pixels_per_degree);
    if (job.stopRequested())
        return cancelled();
    const Seen b = look(test, options.pixels_per_degree);
    if (job.stopRequested())
        return cancelled();
    std::vector<float> map(a.channels[0].values.size());
    const auto feature = [](const Plane& x, const Plane& y, std::size_t i) {
        return std::abs(double{x.values[i]} - double{y.values[i]});
    };
    tbb::parallel_for(std::uint32_t{0}, reference.height_px, [&](std::uint32_t y) {
        const std::size_t begin = std::size_t{y} * reference.width_px;
        for (std::size_t i = begin; i < begin + reference.width_px; ++i) {
            const double color =
                mappedColorDifference(hyab(labAt(a.channels, i), labAt(b.channels, i)));
            const double features = std::max(feature(a.features.edges, b.features.edges, i),
                                             feature(a.features.points, b.features.points, i));
            const double amplified = std::pow(features / std::numbers::sqrt2, kQf);
            map[i] = static_cast<float>(std::pow(color, 1.0 - std::min(amplified, 1.0)));
        }
    });
    return map;
}

} // namespace lodestone
