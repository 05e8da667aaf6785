#include "render/picture_texture.h"

#include <algorithm>

namespace lodestone {

void PictureTexture::upload(std::span<const std::uint8_t> rgba, const ViewSize& size) {
    if (rgba.empty())
        return;
    const std::size_t stride = std::size_t{4} * static_cast<std::size_t>(size.width_px);
    const auto height = static_cast<std::size_t>(size.height_px);
    std::vector<std::uint8_t> rows(rgba.size());
    for (std::size_t y = 0; y < height; ++y)
        std::copy_n(&rgba[(height - 1 - y) * stride], stride, &rows[y * stride]);
    texture_ = GlTexture::create();
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D,
                 0,
                 GL_RGBA8,
                 size.width_px,
                 size.height_px,
                 0,
                 GL_RGBA,
                 GL_UNSIGNED_BYTE,
                 rows.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
}

} // namespace lodestone
