#include "scene/decoded_image.h"

#include <limits>
#include <stb_image.h>

namespace lodestone {

namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 27; // 512 MiB decoded

} // namespace

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
    const auto* data = reinterpret_cast<const stbi_uc*>(image.bytes->data());
    const int size_bytes = static_cast<int>(image.bytes->size());
    int channels = 0;
    if (stbi_info_from_memory(data, size_bytes, &decoded.width, &decoded.height, &channels) == 0) {
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
    decoded.rgba = {
        stbi_load_from_memory(
            data, size_bytes, &decoded.width, &decoded.height, &channels, STBI_rgb_alpha),
        stbi_image_free};
    if (!decoded.rgba)
        decoded.fault = "is damaged";
    return decoded;
}

} // namespace lodestone
