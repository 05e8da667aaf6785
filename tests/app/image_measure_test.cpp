#include "app/image_measure.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace lodestone {

namespace {

// Grey pictures, of another brightness for every column and view.
class GreyImages final : public ImageSource {
public:
    Result<RenderReport> render(const RenderRequest&, const JobContext&) override {
        return fail(ErrorKind::Failed, "not asked for");
    }

    Result<void>
    draw(const PictureRequest& request, const PictureSink& sink, const JobContext&) override {
        for (std::size_t column = 0; column < request.columns.size(); ++column)
            for (std::size_t view = 0; view < request.views.size(); ++view) {
                Picture picture{request.width_px, request.height_px, {}};
                picture.rgba.assign(std::size_t{4} * request.width_px * request.height_px,
                                    static_cast<std::uint8_t>(10 * view + 30 * column));
                if (Result<void> taken = sink({column, view}, std::move(picture)); !taken)
                    return taken;
            }
        return {};
    }
};

glm::dvec3 directionOf(const OrbitView& view) {
    const double azimuth = view.azimuth_deg * std::numbers::pi / 180.0;
    const double elevation = view.elevation_deg * std::numbers::pi / 180.0;
    return {std::sin(azimuth) * std::cos(elevation),
            std::sin(elevation),
            std::cos(azimuth) * std::cos(elevation)};
}

} // namespace

TEST(ImageMeasure, ViewsAreTheCornersOfAnIcosahedron) {
    const auto views = measuringViews();
    for (const OrbitView& view : views) {
        int neighbours = 0; // at 63.4 degrees; the others are at 116.6 and 180
        for (const OrbitView& other : views) {
            const double cosine = glm::dot(directionOf(view), directionOf(other));
            EXPECT_NEAR(std::min(std::abs(std::abs(cosine) - 1.0),
                                 std::abs(std::abs(cosine) - 1.0 / std::sqrt(5.0))),
                        0.0,
                        1e-9);
            neighbours += std::abs(cosine - 1.0 / std::sqrt(5.0)) < 1e-9 ? 1 : 0;
        }
        EXPECT_EQ(neighbours, 5);
    }
}

TEST(ImageMeasure, EveryColumnIsComparedWithTheFirstOne) {
    GreyImages images;
    ImageMeasureOptions options;
    options.size_px = 16;
    const std::array<ImageColumn, 3> columns;
    const auto differences = measureImages(images, columns, options, {});
    ASSERT_TRUE(differences);
    ASSERT_EQ(differences->size(), 2u);
    EXPECT_EQ((*differences)[0].cameras, 12u);
    // Bytes differ by 30 and by 60 in every picture.
    EXPECT_NEAR((*differences)[0].psnr_db, 20.0 * std::log10(255.0 / 30.0), 1e-9);
    EXPECT_NEAR((*differences)[1].psnr_db, 20.0 * std::log10(255.0 / 60.0), 1e-9);
    EXPECT_LT((*differences)[0].flip, (*differences)[1].flip);
}

TEST(ImageMeasure, WhatCannotBeComparedEndsTheDrawing) {
    GreyImages images;
    ImageMeasureOptions options;
    options.size_px = 16;
    options.difference.pixels_per_degree = -1.0;
    const std::array<ImageColumn, 2> columns;
    const auto differences = measureImages(images, columns, options, {});
    ASSERT_FALSE(differences);
    EXPECT_EQ(differences.error().kind, ErrorKind::Usage);
}

} // namespace lodestone
