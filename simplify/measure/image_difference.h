#pragma once
// How different two pictures look. Works on given pixels only; no GL.
#include "scene/job_context.h"
#include "scene/result.h"

#include <cstdint>
#include <span>
#include <vector>

namespace lodestone {

// Rows from the top, no padding, sRGB, as seen: already over its background. alpha 0: nothing but
// background is seen there.
struct Picture {
    std::uint32_t width_px = 0;
    std::uint32_t height_px = 0;
    std::vector<std::uint8_t> rgba; // [4 * width_px * height_px]
};

struct ImageDifferenceOptions {
    // Pixels that one degree of the viewer's sight covers, 1..1000. 67: a 3840 px wide, 0.7 m wide
    // monitor seen from 0.7 m, the published default.
    double pixels_per_degree = 67.0;
};

// Of one pair of pictures, or of several pairs of one size. Pixels count that at least one of the
// two pictures covers (alpha above 0), so that the numbers do not depend on how much background
// there is around; none: equal.
struct ImageDifference {
    double flip = 0.0;         // mean over the pixels, 0 equal .. 1
    double ssim = 1.0;         // mean over the windows around them, 1 equal; of the luma
    double psnr_db = 0.0;      // of the red, green and blue bytes; infinity: equal
    std::uint32_t cameras = 0; // pairs
};

// What both functions below demand: whole pictures of one size, pixels_per_degree in 1..1000.
Result<void>
checkPictures(const Picture& reference, const Picture& test, const ImageDifferenceOptions& options);

// FLIP for low-dynamic-range pictures: Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom,
// Fairchild 2020, from the published definition. The same when the two are swapped.
// Result: [width_px * height_px], rows from the top, 0 equal .. 1.
// Errors: BadInput for pictures and Usage for options that checkPictures refuses; Cancelled.
// Any thread; O(pixels * pixels_per_degree), parallel; the same for any number of threads.
Result<std::vector<float>> flipMap(const Picture& reference,
                                   const Picture& test,
                                   const ImageDifferenceOptions& options,
                                   const JobContext& job);

// FLIP; SSIM (Wang, Bovik, Sheikh, Simoncelli 2004: Gaussian window of 11 x 11 px, sigma 1.5 px,
// inside the picture only, smaller pictures as a single window); PSNR. One pair. As flipMap.
Result<ImageDifference> comparePictures(const Picture& reference,
                                        const Picture& test,
                                        const ImageDifferenceOptions& options,
                                        const JobContext& job);

// Of all pairs together, each weighing as many cameras as it counts; PSNR is that of the mean
// squared error. No pair: equal pictures of 0 cameras.
ImageDifference combined(std::span<const ImageDifference> pairs);

} // namespace lodestone
