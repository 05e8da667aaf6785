#include "render/picture_texture.h"

#include <algorithm>

namespace lodestone {

void PictureTexture::upload(const Pixels& pixels) {
    if (pixels.empty())
        return;
    const std::size_t stride = std::size_t(4) * pixels.width;
    std::vector<std::uint8_t> rows(pixels.rgba.size());
    for (std::size_t y = 0; y < pixels.height; ++y)
        std::copy_n(&pixels.rgba[(pixels.height - 1 - y) * stride], stride, &rows[y * stride]);
    texture_ = GlTexture::create();
    glBindTexture(GL_TEXTURE_2D, texture_.name());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTexImage2D(GL_TEXTURE_2D,
                 0,
                 GL_RGBA8,
                 static_cast<GLsizei>(pixels.width),
                 static_cast<GLsizei>(pixels.height),
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
