#include "simplify/measure/image_difference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <tbb/global_control.h>

namespace lodestone {

namespace {

using Rgb = std::array<std::uint8_t, 3>;

Picture filled(std::uint32_t width, std::uint32_t height, Rgb color) {
    Picture picture{width, height, {}};
    for (std::size_t i = 0; i < std::size_t{width} * height; ++i)
        picture.rgba.insert(picture.rgba.end(), {color[0], color[1], color[2], 255});
    return picture;
}

void paint(Picture& picture, std::uint32_t x, std::uint32_t y, Rgb color) {
    std::copy(color.begin(),
              color.end(),
              picture.rgba.begin() + 4 * (std::ptrdiff_t{y} * picture.width_px + x));
}

// A white disk on grey, its middle moved right by `shift` pixels.
Picture disk(int shift) {
    Picture picture = filled(96, 64, {90, 90, 90});
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 96; ++x)
            if (std::hypot(x - 40 - shift, y - 32) < 15.0)
                paint(picture,
                      static_cast<std::uint32_t>(x),
                      static_cast<std::uint32_t>(y),
                      {255, 255, 255});
    return picture;
}

// With so many pixels more on every side, and all that is grey as background.
Picture amidBackground(const Picture& inner, std::uint32_t margin) {
    Picture picture =
        filled(inner.width_px + 2 * margin, inner.height_px + 2 * margin, {90, 90, 90});
    for (std::uint32_t y = 0; y < inner.height_px; ++y)
        std::copy_n(inner.rgba.begin() + 4 * std::ptrdiff_t{y} * inner.width_px,
                    4 * inner.width_px,
                    picture.rgba.begin() +
                        4 * (std::ptrdiff_t{y + margin} * picture.width_px + margin));
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        if (picture.rgba[i] == 90)
            picture.rgba[i + 3] = 0;
    return picture;
}

Picture noise(unsigned seed) {
    Picture picture = filled(80, 60, {0, 0, 0});
    std::mt19937 random(seed);
    for (std::uint8_t& byte : picture.rgba)
        byte = static_cast<std::uint8_t>(random() & 0xFFu);
    return picture;
}

ImageDifference compare(const Picture& a, const Picture& b) {
    const Result<ImageDifference> difference = comparePictures(a, b, {}, {});
    EXPECT_TRUE(difference);
    return difference.value_or(ImageDifference{});
}

} // namespace

TEST(ImageDifference, OfEqualPicturesIsZero) {
    const ImageDifference difference = compare(noise(1), noise(1));
    EXPECT_EQ(difference.flip, 0.0);
    EXPECT_EQ(difference.ssim, 1.0);
    EXPECT_TRUE(std::isinf(difference.psnr_db));
    EXPECT_EQ(difference.cameras, 1u);
}

TEST(ImageDifference, OfBlackAndWhiteIsOne) {
    // The largest lightness difference: power^0.7 of 100 against that of green and blue.
    const ImageDifference difference =
        compare(filled(32, 32, {0, 0, 0}), filled(32, 32, {255, 255, 255}));
    EXPECT_NEAR(difference.flip, 0.967, 0.002);
    EXPECT_NEAR(difference.psnr_db, 0.0, 1e-9);
    EXPECT_LT(difference.ssim, 0.001);
}

TEST(ImageDifference, OfGreenAndBlueIsTheLargestFlip) {
    const ImageDifference difference =
        compare(filled(32, 32, {0, 255, 0}), filled(32, 32, {0, 0, 255}));
    EXPECT_NEAR(difference.flip, 1.0, 1e-4);
}

TEST(ImageDifference, PsnrFollowsTheMeanSquaredError) {
    // 10 log10(255^2 / 5^2)
    const ImageDifference difference =
        compare(filled(20, 20, {100, 100, 100}), filled(20, 20, {105, 105, 105}));
    EXPECT_NEAR(difference.psnr_db, 34.1514, 1e-3);
}

TEST(ImageDifference, SsimOfFlatPicturesIsItsLuminanceTerm) {
    const double a = 100.0 / 255.0;
    const double b = 150.0 / 255.0;
    const ImageDifference difference =
        compare(filled(20, 20, {100, 100, 100}), filled(20, 20, {150, 150, 150}));
    EXPECT_NEAR(difference.ssim, (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-3);
}

TEST(ImageDifference, HowMuchAPixelIsCoveredDoesNotCount) {
    Picture faded = disk(0);
    for (std::size_t i = 3; i < faded.rgba.size(); i += 4)
        faded.rgba[i] = 7;
    EXPECT_EQ(compare(disk(0), faded).flip, 0.0);
    EXPECT_TRUE(std::isinf(compare(disk(0), faded).psnr_db));
}

TEST(ImageDifference, IsTheSameWithMoreBackgroundAround) {
    const ImageDifference narrow =
        compare(amidBackground(disk(0), 16), amidBackground(disk(3), 16));
    const ImageDifference wide = compare(amidBackground(disk(0), 64), amidBackground(disk(3), 64));
    EXPECT_GT(narrow.flip, 0.05);
    EXPECT_NEAR(wide.flip, narrow.flip, 1e-6);
    EXPECT_NEAR(wide.ssim, narrow.ssim, 1e-6);
    EXPECT_NEAR(wide.psnr_db, narrow.psnr_db, 1e-9);
}

TEST(ImageDifference, OfBackgroundAloneIsZero) {
    Picture nothing = filled(40, 40, {90, 90, 90});
    for (std::size_t i = 3; i < nothing.rgba.size(); i += 4)
        nothing.rgba[i] = 0;
    const ImageDifference difference = compare(nothing, nothing);
    EXPECT_EQ(difference.flip, 0.0);
    EXPECT_EQ(difference.ssim, 1.0);
    EXPECT_TRUE(std::isinf(difference.psnr_db));
    EXPECT_EQ(difference.cameras, 1u);
}

TEST(ImageDifference, GrowsWithTheShiftOfADisk) {
    const Picture still = disk(0);
    double flip = 0.0;
    double ssim = 1.0;
    for (const int shift : {1, 2, 4, 8}) {
        const ImageDifference difference = compare(still, disk(shift));
        EXPECT_GT(difference.flip, flip) << shift;
        EXPECT_LT(difference.ssim, ssim) << shift;
        flip = difference.flip;
        ssim = difference.ssim;
    }
}

TEST(ImageDifference, IsTheSameWhenSwapped) {
    const ImageDifference there = compare(disk(0), disk(3));
    const ImageDifference back = compare(disk(3), disk(0));
    EXPECT_DOUBLE_EQ(there.flip, back.flip);
    EXPECT_DOUBLE_EQ(there.ssim, back.ssim);
    EXPECT_DOUBLE_EQ(there.psnr_db, back.psnr_db);
}

TEST(ImageDifference, FlipMapIsLargeWhereThePicturesDifferAndZeroFarAway) {
    Picture dotted = filled(64, 64, {128, 128, 128});
    for (std::uint32_t y = 30; y < 34; ++y)
        for (std::uint32_t x = 30; x < 34; ++x)
            paint(dotted, x, y, {255, 40, 40});
    const auto map = flipMap(filled(64, 64, {128, 128, 128}), dotted, {}, {});
    ASSERT_TRUE(map);
    ASSERT_EQ(map->size(), 64u * 64u);
    EXPECT_GT((*map)[32 * 64 + 32], 0.3f);
    EXPECT_NEAR((*map)[2 * 64 + 2], 0.0f, 1e-3f);
    const auto largest = std::ranges::max_element(*map) - map->begin();
    EXPECT_NEAR(static_cast<double>(largest % 64), 31.5, 3.0);
    EXPECT_NEAR(static_cast<double>(largest / 64), 31.5, 3.0);
}

TEST(ImageDifference, FromFartherAwayThePatternBlursAway) {
    Picture checker = filled(64, 64, {0, 0, 0});
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 64; ++x)
            if ((x + y) % 2 == 0)
                paint(checker, x, y, {255, 255, 255});
    const Picture grey = filled(64, 64, {188, 188, 188}); // half the light
    const auto near = comparePictures(checker, grey, {20.0}, {});
    const auto far = comparePictures(checker, grey, {120.0}, {});
    ASSERT_TRUE(near && far);
    EXPECT_GT(near->flip, 2.0 * far->flip);
}

TEST(ImageDifference, IsBitEqualForAnyNumberOfThreads) {
    const auto compare_with = [](std::size_t thread_count) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, thread_count);
        return compare(noise(3), noise(4));
    };
    EXPECT_EQ(compare_with(1).flip, compare_with(4).flip);
    EXPECT_EQ(compare_with(1).ssim, compare_with(4).ssim);
}

TEST(ImageDifference, CombinedIsTheMeanOverTheCameras) {
    const ImageDifference one = compare(disk(0), disk(4));
    const ImageDifference equal = compare(disk(0), disk(0));
    const std::array<ImageDifference, 2> pairs = {one, equal};
    const ImageDifference both = combined(pairs);
    EXPECT_EQ(both.cameras, 2u);
    EXPECT_DOUBLE_EQ(both.flip, 0.5 * one.flip);
    EXPECT_DOUBLE_EQ(both.ssim, 0.5 * (one.ssim + 1.0));
    EXPECT_NEAR(both.psnr_db, one.psnr_db + 10.0 * std::log10(2.0), 1e-9); // half the error
}

TEST(ImageDifference, PicturesThatDoNotFitAreRefused) {
    const Picture picture = filled(8, 8, {1, 2, 3});
    Picture torn = picture;
    torn.rgba.pop_back();
    for (const Picture& other : {filled(8, 9, {1, 2, 3}), Picture{}, torn}) {
        const auto difference = comparePictures(picture, other, {}, {});
        ASSERT_FALSE(difference);
        EXPECT_EQ(difference.error().kind, ErrorKind::BadInput);
    }
    for (const double density : {0.0, -1.0, std::nan(""), 1e9}) {
        const auto difference = comparePictures(picture, picture, {density}, {});
        ASSERT_FALSE(difference);
        EXPECT_EQ(difference.error().kind, ErrorKind::Usage);
    }
}

TEST(ImageDifference, PicturesSmallerThanTheWindowCanBeCompared) {
    const ImageDifference difference =
        compare(filled(1, 1, {255, 0, 0}), filled(1, 1, {250, 0, 0}));
    EXPECT_GT(difference.flip, 0.0);
    EXPECT_LT(difference.ssim, 1.0);
    EXPECT_GT(difference.ssim, 0.9);
}

} // namespace lodestone
