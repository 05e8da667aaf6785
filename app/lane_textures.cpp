#include "app/lane_textures.h"

#include "scene/decoded_image.h"

#include <algorithm>
#include <limits>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// Pixels that are someone else's.
struct PixelsView {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    const std::uint8_t* rgba = nullptr; // [4 * width * height]
};

PixelsView viewOf(const ImagePreview& preview) {
    return {preview.width, preview.height, preview.rgba.data()};
}

// Means of two by two pixels; a last odd row or column is left out.
ImagePreview halved(const PixelsView& from) {
    ImagePreview half;
    half.width = std::max(1u, from.width / 2);
    half.height = std::max(1u, from.height / 2);
    half.rgba.resize(std::size_t{4} * half.width * half.height);
    for (std::uint32_t y = 0; y < half.height; ++y)
        for (std::uint32_t x = 0; x < half.width; ++x)
            for (std::uint32_t c = 0; c < 4; ++c) {
                unsigned sum = 2;
                for (std::uint32_t k = 0; k < 4; ++k) {
                    const std::size_t row = std::min(2 * y + k / 2, from.height - 1);
                    const std::size_t column = std::min(2 * x + k % 2, from.width - 1);
                    sum += from.rgba[4 * (row * from.width + column) + c];
                }
                half.rgba[4 * (std::size_t{y} * half.width + x) + c] =
                    static_cast<std::uint8_t>(sum / 4);
            }
    return half;
}

struct Shrunk {
    ImagePreview preview;
    std::uint32_t width = 0; // of the image itself
};

// Halved right out of the decoder's pixels: those of a large image are never held twice.
Shrunk shrunk(const Image& image, std::uint32_t max_side_px) {
    DecodedImage decoded = decodeImage(image, std::numeric_limits<int>::max());
    Shrunk result;
    if (!decoded.rgba)
        return result;
    const PixelsView whole{static_cast<std::uint32_t>(decoded.width),
                           static_cast<std::uint32_t>(decoded.height),
                           decoded.rgba.get()};
    result.width = whole.width;
    ImagePreview& preview = result.preview;
    if (std::max(whole.width, whole.height) > max_side_px)
        preview = halved(whole);
    else
        preview = {whole.width,
                   whole.height,
                   {whole.rgba, whole.rgba + std::size_t{4} * whole.width * whole.height}};
    decoded.rgba.reset();
    while (std::max(preview.width, preview.height) > max_side_px)
        preview = halved(viewOf(preview));
    return result;
}

AtlasPreview previewOf(const BakedAtlas& atlas, const Scene& baked, const Scene& original) {
    const Material& material = baked.materials[atlas.material];
    AtlasPreview preview;
    preview.name = material.name;
    preview.texels_per_unit = atlas.texels_per_unit;
    preview.original_texels_per_unit = atlas.original_texels_per_unit;
    const auto put = [](const Scene& scene, std::uint32_t image, ImagePreview& to) {
        if (image >= scene.images.size())
            return 0u;
        Shrunk made = shrunk(scene.images[image], LaneTextures::kPreviewSide);
        to = std::move(made.preview);
        return made.width;
    };
    preview.before_px = put(original, atlas.original_image, preview.before);
    preview.after_px = put(baked, material.base_color_texture.image, preview.after);
    return preview;
}

} // namespace

Result<LaneTexturesPtr> makeLaneTextures(const LaneTexturesInput& input, const JobContext& job) {
    Result<BakedScene> baked = input.source->transferred(*input.lod, input.options, job);
    if (!baked)
        return tl::unexpected<Error>(std::move(baked.error()));
    auto textures = std::make_shared<LaneTextures>();
    textures->baked = std::move(*baked);
    textures->lod = std::make_shared<const Lod>(fullLod(*textures->baked.scene));
    textures->options = input.options;
    textures->lod_revision = input.lod_revision;
    const std::vector<BakedAtlas>& atlases = textures->baked.atlases;
    textures->previews.resize(std::min(atlases.size(), LaneTextures::kMostPreviews));
    tbb::parallel_for(std::size_t{0}, textures->previews.size(), [&](std::size_t i) {
        if (!job.stopRequested())
            textures->previews[i] =
                previewOf(atlases[i], *textures->baked.scene, *input.source->scene());
    });
    if (job.stopRequested())
        return cancelled();
    return LaneTexturesPtr(std::move(textures));
}

} // namespace lodestone
