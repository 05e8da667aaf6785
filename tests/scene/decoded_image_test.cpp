#include "scene/decoded_image.h"

#include <gtest/gtest.h>
#include <webp/encode.h>

namespace lodestone {

namespace {

// Two texels, red and half transparent blue, without loss.
Image webpImage() {
    const std::array<std::uint8_t, 8> rgba{255, 0, 0, 255, 0, 0, 255, 128};
    std::uint8_t* encoded = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), 2, 1, 8, &encoded);
    const auto* bytes = reinterpret_cast<const std::byte*>(encoded);
    Image image;
    image.mime_type = "image/webp";
    image.bytes = std::make_shared<const std::vector<std::byte>>(bytes, bytes + size);
    WebPFree(encoded);
    return image;
}

Image withBytes(const Image& image, std::vector<std::byte> bytes) {
    Image changed = image;
    changed.bytes = std::make_shared<const std::vector<std::byte>>(std::move(bytes));
    return changed;
}

} // namespace

TEST(DecodedImage, WebpIsDecodedWithItsAlpha) {
    const DecodedImage decoded = decodeImage(webpImage(), 16);
    ASSERT_TRUE(decoded.rgba) << decoded.fault;
    EXPECT_EQ(decoded.width, 2);
    EXPECT_EQ(decoded.height, 1);
    EXPECT_EQ(decoded.rgba.get()[0], 255);
    EXPECT_EQ(decoded.rgba.get()[6], 255);
    EXPECT_EQ(decoded.rgba.get()[7], 128);
}

TEST(DecodedImage, WhatIsDamagedTooLargeOrUnknownSaysSo) {
    const Image whole = webpImage();
    std::vector<std::byte> half(whole.bytes->begin(),
                                whole.bytes->begin() +
                                    static_cast<std::ptrdiff_t>(whole.bytes->size() - 6));
    const DecodedImage damaged = decodeImage(withBytes(whole, half), 16);
    EXPECT_FALSE(damaged.rgba);
    EXPECT_FALSE(damaged.fault.empty());
    EXPECT_NE(decodeImage(whole, 1).fault.find("2 x 1 px"), std::string::npos);
    Image ktx = withBytes(whole, std::vector<std::byte>(100, std::byte{7}));
    ktx.mime_type = "image/ktx2";
    EXPECT_NE(decodeImage(ktx, 16).fault.find("image/ktx2 cannot be shown"), std::string::npos);
}

TEST(DecodedImage, IsNamedByNumberAndName) {
    Scene scene;
    scene.images.resize(2);
    scene.images[1].uri = "bark.webp";
    EXPECT_EQ(imageLabel(scene, 0), "image 0");
    EXPECT_EQ(imageLabel(scene, 1), "image 1 'bark.webp'");
}

} // namespace lodestone
