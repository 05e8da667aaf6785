#include "scene/decoded_image.h"

#include <limits>
#include <span>
#include <stb_image.h>
#include <webp/decode.h>

namespace lodestone {

namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 27; // 512 MiB decoded

enum class Coder : std::uint8_t { Stb, WebP, None };

// Who reads the bytes; sets the size if anybody does.
Coder coderOf(std::span<const unsigned char> bytes, DecodedImage& decoded) {
    int channels = 0;
    if (stbi_info_from_memory(bytes.data(),
                              static_cast<int>(bytes.size()),
                              &decoded.width,
                              &decoded.height,
                              &channels) != 0)
        return Coder::Stb;
    if (WebPGetInfo(bytes.data(), bytes.size(), &decoded.width, &decoded.height) != 0)
        return Coder::WebP;
    return Coder::None;
}

void decode(std::span<const unsigned char> bytes, Coder coder, DecodedImage& decoded) {
    int channels = 0;
    if (coder == Coder::WebP)
        decoded.rgba = {WebPDecodeRGBA(bytes.data(), bytes.size(), &decoded.width, &decoded.height),
                        WebPFree};
    else
        decoded.rgba = {stbi_load_from_memory(bytes.data(),
                                              static_cast<int>(bytes.size()),
                                              &decoded.width,
                                              &decoded.height,
                                              &channels,
                                              STBI_rgb_alpha),
                        stbi_image_free};
}

std::span<const unsigned char> bytesOf(const Image& image) {
    if (!image.bytes || image.bytes->size() > std::size_t(std::numeric_limits<int>::max()))
        return {};
    return {reinterpret_cast<const unsigned char*>(image.bytes->data()), image.bytes->size()};
}

} // namespace

glm::ivec2 imageSize(const Image& image) {
    DecodedImage decoded;
    const std::span<const unsigned char> bytes = bytesOf(image);
    if (bytes.empty() || coderOf(bytes, decoded) == Coder::None)
        return {0, 0};
    return {decoded.width, decoded.height};
}

DecodedImage decodeImage(const Image& image, int max_size_px) {
    DecodedImage decoded;
    if (!image.bytes || image.bytes->empty()) {
        decoded.fault = "is missing";
        return decoded;
    }
    if (image.bytes->size() > std::size_t(std::numeric_limits<int>::max())) {
        decoded.fault = "is larger than 2 GiB";
        return decoded;
    }
    const std::span<const unsigned char> bytes = bytesOf(image);
    const Coder coder = coderOf(bytes, decoded);
    if (coder == Coder::None) {
        const std::string type = image.mime_type.empty() ? "its format" : image.mime_type;
        decoded.fault = type + " cannot be shown (it is kept in exports)";
        return decoded;
    }
    if (decoded.width < 1 || decoded.height < 1 || decoded.width > max_size_px ||
        decoded.height > max_size_px || std::int64_t(decoded.width) * decoded.height > kMaxPixels) {
        decoded.fault = std::to_string(decoded.width) + " x " + std::to_string(decoded.height) +
                        " px are more than the GPU takes";
        return decoded;
    }
    decode(bytes, coder, decoded);
    if (!decoded.rgba)
        decoded.fault = "is damaged";
    return decoded;
}

std::string imageLabel(const Scene& scene, std::uint32_t index) {
    const Image& image = scene.images[index];
    const std::string& name = !image.name.empty() ? image.name : image.uri;
    return "image " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

} // namespace lodestone
