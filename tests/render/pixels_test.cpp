#include "render/pixels.h"

#include <filesystem>
#include <gtest/gtest.h>

namespace lodestone {
namespace {

TEST(Pixels, SheetKeepsPicturesApartAndCentred) {
    const Rgba8 red{255, 0, 0, 255};
    const Rgba8 green{0, 255, 0, 255};
    const SheetCell cells[] = {{Pixels(10, 10, red), ""}, {Pixels(4, 4, green), ""}};
    SheetOptions options;
    options.gap_px = 2;
    const Result<Pixels> sheet = composeSheet(cells, options);
    ASSERT_TRUE(sheet) << sheet.error().message;
    EXPECT_EQ(sheet->width, 26u);
    EXPECT_EQ(sheet->height, 14u);
    EXPECT_EQ(sheet->at(2, 2), red);
    EXPECT_EQ(sheet->at(12, 7), options.background);
    EXPECT_EQ(sheet->at(19, 7), green);
    EXPECT_EQ(sheet->at(15, 3), options.background);
}

TEST(Pixels, SheetsOfSeveralPicturesAreRowsOfAFew) {
    const std::pair<std::uint32_t, std::uint32_t> wanted[] = {
        {1, 1}, {2, 2}, {3, 3}, {4, 2}, {5, 3}, {6, 3}, {9, 3}, {10, 4}};
    for (const auto& [pictures, columns] : wanted)
        EXPECT_EQ(sheetColumns(pictures), columns) << pictures;
    EXPECT_EQ(sheetColumns(0), 1u);
}

TEST(Pixels, MissingFontIsAnErrorThatNamesIt) {
    const SheetCell cells[] = {{Pixels(10, 10, {}), "label"}};
    SheetOptions options;
    options.font = "no_such_font.ttf";
    const Result<Pixels> sheet = composeSheet(cells, options);
    ASSERT_FALSE(sheet);
    EXPECT_NE(sheet.error().message.find("no_such_font.ttf"), std::string::npos);
}

TEST(Pixels, FailedPngLeavesNothingBehind) {
    const std::filesystem::path folder =
        std::filesystem::path(testing::TempDir()) / "no_such_folder";
    const Result<void> written = writePng(folder / "a.png", Pixels(2, 2, {}));
    ASSERT_FALSE(written);
    EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(Pixels, PngReplacesAnExistingFile) {
    const std::filesystem::path path =
        std::filesystem::path(testing::TempDir()) / "lodestone_pixels_test.png";
    ASSERT_TRUE(writePng(path, Pixels(64, 64, {1, 2, 3, 255})));
    ASSERT_TRUE(writePng(path, Pixels(2, 2, {1, 2, 3, 255})));
    EXPECT_LT(std::filesystem::file_size(path), 200u);
    std::filesystem::remove(path);
}

} // namespace
} // namespace lodestone
