#include "simplify/bake/encoded_atlas.h"

#include <stb_image_write.h>

namespace lodestone {

namespace {

using Bytes = std::vector<std::byte>;

void append(void* to, void* data, int size) {
    const auto* begin = static_cast<const std::byte*>(data);
    auto& all = *static_cast<Bytes*>(to);
    all.insert(all.end(), begin, begin + size);
}

std::vector<std::uint8_t> withoutAlpha(std::span<const std::uint8_t> rgba) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(rgba.size() / 4 * 3);
    for (std::size_t i = 0; i + 3 < rgba.size(); i += 4)
        rgb.insert(rgb.end(), {rgba[i], rgba[i + 1], rgba[i + 2]});
    return rgb;
}

// Empty if there was not enough memory.
Bytes encoded(const std::uint8_t* texels, int side, int channels, std::optional<int> jpeg_quality) {
    Bytes bytes;
    const int done =
        jpeg_quality
            ? stbi_write_jpg_to_func(append, &bytes, side, side, channels, texels, *jpeg_quality)
            : stbi_write_png_to_func(append, &bytes, side, side, channels, texels, 0);
    return done == 0 ? Bytes() : bytes;
}

} // namespace

bool isJpeg(const Image& image) {
    return image.bytes && image.bytes->size() > 2 && (*image.bytes)[0] == std::byte{0xff} &&
           (*image.bytes)[1] == std::byte{0xd8};
}

Result<Image>
encodedAtlas(std::string name, const AtlasPixels& pixels, const BakeOptions& options) {
    const bool opaque = pixels.channels == Channels::Rgb;
    const std::vector<std::uint8_t> rgb =
        opaque ? withoutAlpha(pixels.rgba) : std::vector<std::uint8_t>();
    const std::uint8_t* const texels = opaque ? rgb.data() : pixels.rgba.data();
    const auto side = static_cast<int>(pixels.size_px);
    const auto channels = static_cast<int>(pixels.channels);
    const bool automatic = options.format == AtlasFormat::Auto;
    const bool may_be_jpeg =
        opaque && (options.format == AtlasFormat::Jpeg || (automatic && pixels.from_jpeg));
    Bytes jpeg;
    Bytes png;
    if (may_be_jpeg)
        jpeg = encoded(texels, side, channels, options.jpeg_quality);
    if (!may_be_jpeg || automatic)
        png = encoded(texels, side, channels, std::nullopt);
    const bool is_jpeg = !jpeg.empty() && (png.empty() || jpeg.size() < png.size());
    Bytes& bytes = is_jpeg ? jpeg : png;
    if (bytes.empty())
        return fail(ErrorKind::Failed,
                    "not enough memory for an atlas of " + std::to_string(pixels.size_px) +
                        " pixels; use a smaller one");
    return Image{std::move(name),
                 is_jpeg ? "image/jpeg" : "image/png",
                 {},
                 std::make_shared<const Bytes>(std::move(bytes))};
}

} // namespace lodestone
