#include "render/gpu_texture.h"

#include <cstddef>
#include <tbb/parallel_for.h>

namespace lodestone {

std::vector<DecodedImage>
decodeImages(const Scene& scene, const std::vector<TextureWish>& wishes, int max_size_px) {
    std::vector<DecodedImage> decoded(wishes.size());
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
