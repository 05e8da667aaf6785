#include "scene/decoded_image.h"
#include "scene/scene_builder.h"
#include "simplify/bake/bake_parameters.h"
#include "simplify/bake/encoded_atlas.h"
#include "simplify/bake/texel_density.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>
#include <random>

using namespace lodestone;

namespace {

constexpr std::uint32_t kSide = 64;

// What PNG cannot make small: a smooth ramp with noise.
std::vector<std::uint8_t> noisy() {
    std::mt19937 random(3);
    std::vector<std::uint8_t> rgba;
    for (std::uint32_t at = 0; at < kSide * kSide; ++at) {
        const auto ramp = static_cast<std::uint8_t>(60 + at / kSide + random() % 8);
        rgba.insert(rgba.end(), {ramp, static_cast<std::uint8_t>(ramp / 2), 90, 255});
    }
    return rgba;
}

std::string typeOf(const AtlasPixels& pixels, const BakeOptions& options) {
    const Result<Image> image = encodedAtlas("atlas", pixels, options);
    return image ? image->mime_type : image.error().message;
}

// A square of side 2 that the whole texture covers.
Geometry square() {
    Geometry geometry;
    geometry.positions = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    geometry.indices = {0, 1, 2, 0, 2, 3};
    const std::vector<float> uv{0, 0, 1, 0, 1, 1, 0, 1};
    return *meshes::withAttribute(geometry, "TEXCOORD_0", uv);
}

} // namespace

TEST(EncodedAtlas, IsJpegWhereItsSourcesAreAndPngWhereOneLosesNothing) {
    const std::vector<std::uint8_t> rgba = noisy();
    const AtlasPixels from_jpeg{rgba, kSide, Channels::Rgb, true};
    const AtlasPixels from_png{rgba, kSide, Channels::Rgb, false};
    const AtlasPixels with_alpha{rgba, kSide, Channels::Rgba, true};
    BakeOptions options;
    EXPECT_EQ(typeOf(from_jpeg, options), "image/jpeg");
    EXPECT_EQ(typeOf(from_png, options), "image/png");
    EXPECT_EQ(typeOf(with_alpha, options), "image/png");
    options.format = AtlasFormat::Png;
    EXPECT_EQ(typeOf(from_jpeg, options), "image/png");
    options.format = AtlasFormat::Jpeg;
    EXPECT_EQ(typeOf(from_png, options), "image/jpeg");
    EXPECT_EQ(typeOf(with_alpha, options), "image/png");
}

TEST(EncodedAtlas, OfOneColourIsPngEvenFromJpegBecauseThatIsSmaller) {
    const std::vector<std::uint8_t> rgba(4 * kSide * kSide, 128);
    EXPECT_EQ(typeOf({rgba, kSide, Channels::Rgb, true}, {}), "image/png");
}

TEST(EncodedAtlas, ComesBackAsItWasButForWhatJpegLoses) {
    const std::vector<std::uint8_t> rgba = noisy();
    for (const AtlasFormat format : {AtlasFormat::Png, AtlasFormat::Jpeg}) {
        BakeOptions options;
        options.format = format;
        const Result<Image> image =
            encodedAtlas("atlas", {rgba, kSide, Channels::Rgb, false}, options);
        ASSERT_TRUE(image);
        EXPECT_EQ(isJpeg(*image), format == AtlasFormat::Jpeg);
        const DecodedImage back = decodeImage(*image, 1024);
        ASSERT_TRUE(back.rgba);
        ASSERT_EQ(back.width, static_cast<int>(kSide));
        int worst = 0;
        for (std::size_t i = 0; i < rgba.size(); ++i)
            worst = std::max(worst, std::abs(int{back.rgba.get()[i]} - int{rgba[i]}));
        EXPECT_LE(worst, format == AtlasFormat::Png ? 0 : 12);
    }
}

TEST(EncodedAtlas, OfLowerQualityIsSmallerAndTheSameOptionsGiveTheSameBytes) {
    const std::vector<std::uint8_t> rgba = noisy();
    const auto bytesAt = [&](int quality) {
        BakeOptions options;
        options.format = AtlasFormat::Jpeg;
        options.jpeg_quality = quality;
        return *encodedAtlas("atlas", {rgba, kSide, Channels::Rgb, false}, options)->bytes;
    };
    EXPECT_LT(bytesAt(50).size(), bytesAt(92).size());
    EXPECT_EQ(bytesAt(92), bytesAt(92));
}

TEST(TexelDensity, IsTheTextureOverTheLengthItCovers) {
    const TextureRef texture;
    constexpr glm::dvec2 size_px(kSide, kSide);
    TexelArea once;
    once.add(square(), texture, size_px, 1.0);
    EXPECT_NEAR(once.texelsPerUnit(), 32.0, 1e-6);
    TexelArea twice_as_large;
    twice_as_large.add(square(), texture, size_px, 2.0);
    EXPECT_NEAR(twice_as_large.texelsPerUnit(), 16.0, 1e-6);
    TexelArea uncovered;
    TextureRef other_coordinates;
    other_coordinates.texcoord = 5;
    uncovered.add(square(), other_coordinates, size_px, 1.0);
    EXPECT_EQ(uncovered.texelsPerUnit(), 0.0);
}

TEST(BakeParameters, EveryEdgeCollapseOffersATransferAndKeepsTexturesUnlessAsked) {
    for (const Algorithm& algorithm : algorithms()) {
        EXPECT_FALSE(bakeOptions(algorithm, {})) << algorithm.id;
        const bool collapses = algorithm.family == Family::EdgeCollapse;
        const ParameterValues asked{{"texture", 1.0},
                                    {"atlas", 2048.0},
                                    {"merge-materials", 1.0},
                                    {"keep-better", 1.0},
                                    {"atlas-format", 2.0},
                                    {"jpeg-quality", 80.0}};
        const std::optional<BakeOptions> options = bakeOptions(algorithm, asked);
        ASSERT_EQ(options.has_value(), collapses) << algorithm.id;
        if (collapses) {
            EXPECT_EQ(*options, (BakeOptions{2048, true, true, {}, AtlasFormat::Jpeg, 80}));
        }
    }
}
