#pragma once
// Small pictures of lanes' textures on the GPU, for the panels that show them. Main thread, context
// current.
#include "app/lane_textures.h"
#include "render/picture_texture.h"

#include <map>

namespace lodestone {

class PreviewTextures {
public:
    // Uploads it the first time. preview: one of the owner's; 0 for an empty one.
    TextureHandle of(const LaneTexturesPtr& owner, const ImagePreview& preview);

    // Once a frame: forgets what the frame has not asked for.
    void endFrame();

private:
    struct Entry {
        LaneTexturesPtr owner; // keeps the key from being used again
        PictureTexture texture;
        bool used = false;
    };

    std::map<const ImagePreview*, Entry> entries_;
};

} // namespace lodestone
