#include "simplify/measure/image_difference.h"

#include "simplify/measure/plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

namespace lodestone {

namespace {

constexpr double kBytePeak = 255.0;
constexpr int kWindowRadius = 5; // SSIM's window: 11 x 11
constexpr double kWindowSigma = 1.5;
// SSIM's constants for a range of 0..1.
constexpr double kC1 = 0.01 * 0.01;
constexpr double kC2 = 0.03 * 0.03;

Plane lumaOf(const Picture& picture) {
    Plane luma(picture.width_px, picture.height_px);
    for (std::size_t i = 0; i < luma.values.size(); ++i) {
        const std::uint8_t* rgba = picture.rgba.data() + 4 * i;
        luma.values[i] =
            static_cast<float>((0.299 * rgba[0] + 0.587 * rgba[1] + 0.114 * rgba[2]) / kBytePeak);
    }
    return luma;
}

Plane product(const Plane& a, const Plane& b) {
    Plane result(a.width, a.height);
    for (std::size_t i = 0; i < result.values.size(); ++i)
        result.values[i] = a.values[i] * b.values[i];
    return result;
}

// Means of a window.
struct WindowMeans {
    double a = 0.0;
    double b = 0.0;
    double aa = 0.0;
    double bb = 0.0;
    double ab = 0.0;
};

double similarity(const WindowMeans& m) {
    const double variances = (m.aa - m.a * m.a) + (m.bb - m.b * m.b);
    const double covariance = m.ab - m.a * m.b;
    return (2.0 * m.a * m.b + kC1) * (2.0 * covariance + kC2) /
           ((m.a * m.a + m.b * m.b + kC1) * (variances + kC2));
}

double meanOf(const Plane& plane) {
    double sum = 0.0;
    for (const float value : plane.values)
        sum += value;
    return sum / static_cast<double>(plane.values.size());
}

// The pixels that at least one of the pictures covers.
class Covered {
public:
    Covered(const Picture& a, const Picture& b) : covered_(a.rgba.size() / 4) {
        for (std::size_t i = 0; i < covered_.size(); ++i)
            covered_[i] = a.rgba[4 * i + 3] > 0 || b.rgba[4 * i + 3] > 0;
    }

    bool operator[](std::size_t pixel) const { return covered_[pixel]; }

    double count() const {
        return static_cast<double>(std::count(covered_.begin(), covered_.end(), true));
    }

private:
    std::vector<bool> covered_;
};

double ssimOf(const Picture& reference, const Picture& test, const Covered& covered) {
    const Plane a = lumaOf(reference);
    const Plane b = lumaOf(test);
    const std::array<Plane, 5> planes = {a, b, product(a, a), product(b, b), product(a, b)};
    constexpr std::uint32_t kSide = 2 * kWindowRadius + 1;
    if (a.width < kSide || a.height < kSide)
        return similarity({meanOf(planes[0]),
                           meanOf(planes[1]),
                           meanOf(planes[2]),
                           meanOf(planes[3]),
                           meanOf(planes[4])});
    const Kernel window = gaussianKernel(kWindowSigma, kWindowRadius);
    std::array<Plane, 5> means;
    for (std::size_t p = 0; p < planes.size(); ++p)
        means[p] = filteredAlongY(filteredAlongX(planes[p], window), window);
    double sum = 0.0;
    std::uint64_t windows = 0;
    for (std::uint32_t y = kWindowRadius; y < a.height - kWindowRadius; ++y)
        for (std::uint32_t x = kWindowRadius; x < a.width - kWindowRadius; ++x) {
            if (!covered[std::size_t{y} * a.width + x])
                continue;
            ++windows;
            sum += similarity({means[0].row(y)[x],
                               means[1].row(y)[x],
                               means[2].row(y)[x],
                               means[3].row(y)[x],
                               means[4].row(y)[x]});
        }
    return windows > 0 ? sum / static_cast<double>(windows) : 1.0;
}

double psnrOf(double mean_squared_error) {
    if (mean_squared_error <= 0.0)
        return std::numeric_limits<double>::infinity();
    return 10.0 * std::log10(kBytePeak * kBytePeak / mean_squared_error);
}

double meanSquaredErrorOf(double psnr_db) {
    return std::isinf(psnr_db) ? 0.0 : kBytePeak * kBytePeak * std::pow(10.0, -0.1 * psnr_db);
}

double meanSquaredError(const Picture& a, const Picture& b, const Covered& covered) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4)
        for (std::size_t c = 0; c < 3 && covered[i / 4]; ++c) {
            const int difference = int{a.rgba[i + c]} - int{b.rgba[i + c]};
            sum += static_cast<std::uint64_t>(difference * difference);
        }
    return static_cast<double>(sum) / (3.0 * covered.count());
}

bool isWhole(const Picture& picture) {
    return picture.width_px > 0 && picture.height_px > 0 &&
           picture.rgba.size() == std::size_t{4} * picture.width_px * picture.height_px;
}

} // namespace

Result<void> checkPictures(const Picture& reference,
                           const Picture& test,
                           const ImageDifferenceOptions& options) {
    constexpr double kMostPixelsPerDegree = 1000.0; // the filters grow with it
    if (!(options.pixels_per_degree >= 1.0 && options.pixels_per_degree <= kMostPixelsPerDegree))
        return fail(ErrorKind::Usage, "image difference: pixels per degree must be 1 to 1000");
    if (!isWhole(reference) || !isWhole(test))
        return badInput("image difference: a picture is empty or not complete; draw it again");
    if (reference.width_px != test.width_px || reference.height_px != test.height_px)
        return badInput("image difference: the pictures differ in size; draw both in one size");
    return {};
}

Result<ImageDifference> comparePictures(const Picture& reference,
                                        const Picture& test,
                                        const ImageDifferenceOptions& options,
                                        const JobContext& job) {
    const Result<std::vector<float>> map = flipMap(reference, test, options, job);
    if (!map)
        return tl::unexpected<Error>(map.error());
    const Covered covered(reference, test);
    ImageDifference difference{0.0, 1.0, psnrOf(0.0), 1};
    if (covered.count() == 0.0)
        return difference;
    for (std::size_t i = 0; i < map->size(); ++i)
        if (covered[i])
            difference.flip += (*map)[i];
    difference.flip /= covered.count();
    difference.ssim = ssimOf(reference, test, covered);
    difference.psnr_db = psnrOf(meanSquaredError(reference, test, covered));
    return difference;
}

ImageDifference combined(std::span<const ImageDifference> pairs) {
    ImageDifference result{0.0, 0.0, 0.0, 0};
    double squared_error = 0.0;
    for (const ImageDifference& pair : pairs) {
        result.flip += pair.flip * pair.cameras;
        result.ssim += pair.ssim * pair.cameras;
        squared_error += meanSquaredErrorOf(pair.psnr_db) * pair.cameras;
        result.cameras += pair.cameras;
    }
    const double cameras = std::max(result.cameras, 1u);
    result.flip /= cameras;
    result.ssim = result.cameras > 0 ? result.ssim / cameras : 1.0;
    result.psnr_db = psnrOf(squared_error / cameras);
    return result;
}

} // namespace lodestone
