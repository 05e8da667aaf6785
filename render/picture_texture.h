#pragma once
// Pixels of the CPU shown as a picture. Main thread, context current.
#include "render/gl_object.h"
#include "render/gpu_scene.h"
#include "render/pixels.h"
#include "render/view.h"

namespace lodestone {

class PictureTexture {
public:
    // Row 0 of the texture is the bottom of the picture, as with View. Nothing for no pixels.
    void upload(const Pixels& pixels);

    TextureHandle texture() const { return texture_.name(); } // 0 before the first upload

private:
    GlTexture texture_;
};

} // namespace lodestone
