#include "app/main/preview_textures.h"

namespace lodestone {

TextureHandle PreviewTextures::of(const LaneTexturesPtr& owner, const ImagePreview& preview) {
    if (preview.empty())
        return 0;
    const auto [found, fresh] = entries_.try_emplace(&preview);
    Entry& entry = found->second;
    entry.used = true;
    if (fresh) {
        entry.owner = owner;
        entry.texture.upload(preview.rgba,
                             {static_cast<int>(preview.width), static_cast<int>(preview.height)});
    }
    return entry.texture.texture();
}

void PreviewTextures::endFrame() {
    std::erase_if(entries_, [](const auto& item) { return !item.second.used; });
    for (auto& item : entries_)
        item.second.used = false;
}

} // namespace lodestone
