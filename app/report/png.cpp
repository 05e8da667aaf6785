#include "app/report/png.h"

#include <stb_image_write.h>

namespace lodestone {

Result<std::string> encodePng(const Picture& picture) {
    constexpr int kChannels = 3;
    const std::size_t pixels = std::size_t{picture.width_px} * picture.height_px;
    if (pixels == 0 || picture.rgba.size() != 4 * pixels)
        return fail(ErrorKind::Usage, "an empty picture cannot become a PNG file");
    std::vector<std::uint8_t> rgb(kChannels * pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        for (std::size_t channel = 0; channel < kChannels; ++channel)
            rgb[kChannels * i + channel] = picture.rgba[4 * i + channel];
    std::string bytes;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data),
                                                   static_cast<std::size_t>(size));
    };
    const int width = static_cast<int>(picture.width_px);
    const int height = static_cast<int>(picture.height_px);
    if (stbi_write_png_to_func(
            append, &bytes, width, height, kChannels, rgb.data(), kChannels * width) == 0)
        return fail(ErrorKind::Failed, "not enough memory for the pictures; close other programs");
    return bytes;
}

} // namespace lodestone
