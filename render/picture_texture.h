#pragma once
// Pixels of the CPU shown as a picture. Main thread, context current.
#include "render/gl_object.h"
#include "render/gpu_scene.h"
#include "render/pixels.h"
#include "render/view.h"

namespace lodestone {

class PictureTexture {
public:
    // rgba: 4 * width_px * height_px, top row first; row 0 of the texture is the bottom of the
    // picture, as with View. Nothing for no pixels.
    void upload(std::span<const std::uint8_t> rgba, const ViewSize& size);

    TextureHandle texture() const { return texture_.name(); } // 0 before the first upload

private:
    GlTexture texture_;
};

} // namespace lodestone
