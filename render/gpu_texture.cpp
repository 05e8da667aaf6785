#include "render/gpu_texture.h"

#include <cstddef>
#include <limits>
#include <memory>
#include <stb_image.h>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 27; // 512 MiB decoded

DecodedImage decodeImage(const Image& image, int max_size_px) {
    DecodedImage decoded{{nullptr, stbi_image_free}, 0, 0, {}};
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
    decoded.rgba.reset(stbi_load_from_memory(
        data, size_bytes, &decoded.width, &decoded.height, &channels, STBI_rgb_alpha));
    if (!decoded.rgba)
        decoded.fault = "is damaged";
    return decoded;
}

std::string imageLabel(const Scene& scene, std::uint32_t index) {
    const Image& image = scene.images[index];
    const std::string& name = !image.name.empty() ? image.name : image.uri;
    return "image " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

} // namespace

std::vector<DecodedImage>
decodeImages(const Scene& scene, const std::vector<TextureWish>& wishes, int max_size_px) {
    std::vector<DecodedImage> decoded;
    for (std::size_t i = 0; i < wishes.size(); ++i)
        decoded.push_back({{nullptr, stbi_image_free}, 0, 0, {}});
    tbb::parallel_for(std::size_t(0), wishes.size(), [&](std::size_t i) {
        decoded[i] = decodeImage(scene.images[wishes[i].image], max_size_px);
        if (!decoded[i].fault.empty())
            decoded[i].fault =
                imageLabel(scene, wishes[i].image) + " " + decoded[i].fault + ": drawn without it";
    });
    return decoded;
}

GpuTexture uploadTexture(GlTexture texture, const DecodedImage& image, ColorSpace color_space) {
    GpuTexture result;
    result.texture = std::move(texture);
    glBindTexture(GL_TEXTURE_2D, result.texture.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D,
                 0,
                 color_space == ColorSpace::Srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8,
                 image.width,
                 image.height,
                 0,
                 GL_RGBA,
                 GL_UNSIGNED_BYTE,
                 image.rgba.get());
    glGenerateMipmap(GL_TEXTURE_2D);
    glBindTexture(GL_TEXTURE_2D, 0);
    result.bytes = std::uint64_t(image.width) * std::uint64_t(image.height) * 16 / 3;
    return result;
}

} // namespace lodestone
