#include "render/pixels.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <fstream>
#include <iterator>
#include <memory>
#include <stb_image_write.h>
#include <stb_truetype.h>
#include <system_error>

namespace lodestone {

namespace {

constexpr std::uint32_t kMaxSide = 32768;

std::string quoted(const std::filesystem::path& path) {
    std::string text(1, '\'');
    text.append(path.string()).push_back('\'');
    return text;
}

void blend(Pixels& target, std::uint32_t x, std::uint32_t y, Rgba8 color, std::uint32_t cover) {
    if (x >= target.width || y >= target.height)
        return;
    Rgba8 below = target.at(x, y);
    for (std::size_t c = 0; c < 4; ++c)
        below[c] =
            static_cast<std::uint8_t>((color[c] * cover + below[c] * (255 - cover) + 127) / 255);
    target.set(x, y, below);
}

// Draws source over target; transparent parts show what is below.
void paste(Pixels& target, const Pixels& source, std::uint32_t left, std::uint32_t top) {
    for (std::uint32_t y = 0; y < source.height; ++y)
        for (std::uint32_t x = 0; x < source.width; ++x) {
            Rgba8 color = source.at(x, y);
            const std::uint32_t cover = color[3];
            color[3] = 255;
            blend(target, left + x, top + y, color, cover);
        }
}

std::vector<std::uint32_t> decodeUtf8(const std::string& text) {
    std::vector<std::uint32_t> codes;
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i++]);
        const int more = lead >= 0xF0 ? 3 : lead >= 0xE0 ? 2 : lead >= 0xC0 ? 1 : 0;
        std::uint32_t code = more == 0 ? lead : lead & (0x3Fu >> more);
        for (int k = 0; k < more && i < text.size(); ++k)
            code = (code << 6) | (static_cast<unsigned char>(text[i++]) & 0x3Fu);
        codes.push_back(code);
    }
    return codes;
}

class LabelFont {
public:
    static Result<LabelFont> open(const std::filesystem::path& path, float size_px) {
        LabelFont font;
        std::ifstream file(path, std::ios::binary);
        font.bytes_.assign(std::istreambuf_iterator<char>(file), {});
        const auto* data = reinterpret_cast<const unsigned char*>(font.bytes_.data());
        // stb_truetype trusts its input: only what starts like a font may reach it.
        const int offset = font.bytes_.size() > 256 ? stbtt_GetFontOffsetForIndex(data, 0) : -1;
        if (offset < 0 || stbtt_InitFont(&font.info_, data, offset) == 0)
            return badInput("font " + quoted(path) + " cannot be read; name a TrueType file");
        font.scale_ = stbtt_ScaleForPixelHeight(&font.info_, size_px);
        return font;
    }

    std::uint32_t width(const std::vector<std::uint32_t>& text) const {
        float x = 0.0f;
        for (const std::uint32_t code : text)
            x += advance(code);
        return static_cast<std::uint32_t>(std::lround(x));
    }

    void draw(Pixels& target,
              const std::vector<std::uint32_t>& text,
              std::array<std::uint32_t, 2> left_top,
              Rgba8 color) const {
        int ascent = 0;
        stbtt_GetFontVMetrics(&info_, &ascent, nullptr, nullptr);
        const int baseline =
            static_cast<int>(left_top[1]) + static_cast<int>(static_cast<float>(ascent) * scale_);
        auto pen = static_cast<float>(left_top[0]);
        for (const std::uint32_t code : text) {
            drawGlyph(target, code, {static_cast<int>(std::lround(pen)), baseline}, color);
            pen += advance(code);
        }
    }

private:
    float advance(std::uint32_t code) const {
        int width = 0;
        stbtt_GetCodepointHMetrics(&info_, static_cast<int>(code), &width, nullptr);
        return static_cast<float>(width) * scale_;
    }

    void drawGlyph(Pixels& target, std::uint32_t code, std::array<int, 2> pen, Rgba8 color) const {
        int width = 0;
        int height = 0;
        int x_offset = 0;
        int y_offset = 0;
        const std::unique_ptr<unsigned char, void (*)(unsigned char*)> bitmap(
            stbtt_GetCodepointBitmap(&info_,
                                     scale_,
                                     scale_,
                                     static_cast<int>(code),
                                     &width,
                                     &height,
                                     &x_offset,
                                     &y_offset),
            [](unsigned char* glyph) { stbtt_FreeBitmap(glyph, nullptr); });
        for (int y = 0; bitmap && y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const int px = pen[0] + x_offset + x;
                const int py = pen[1] + y_offset + y;
                if (px >= 0 && py >= 0)
                    blend(target,
                          static_cast<std::uint32_t>(px),
                          static_cast<std::uint32_t>(py),
                          color,
                          bitmap.get()[y * width + x]);
            }
    }

    std::vector<char> bytes_;
    stbtt_fontinfo info_{};
    float scale_ = 1.0f;
};

struct SheetLayout {
    std::uint32_t columns = 1;
    std::uint32_t cell_width = 0;
    std::uint32_t cell_height = 0;
    std::uint32_t label_height = 0;
    std::uint64_t width = 0;
    std::uint64_t height = 0;
};

SheetLayout layOut(std::span<const SheetCell> cells, const SheetOptions& options) {
    SheetLayout layout;
    const auto count = static_cast<std::uint32_t>(cells.size());
    layout.columns = options.columns == 0 ? std::max(count, 1u) : options.columns;
    layout.columns = std::min(layout.columns, std::max(count, 1u));
    bool labelled = false;
    for (const SheetCell& cell : cells) {
        layout.cell_width = std::max(layout.cell_width, cell.picture.width);
        layout.cell_height = std::max(layout.cell_height, cell.picture.height);
        labelled = labelled || !cell.label.empty();
    }
    if (labelled && !options.font.empty())
        layout.label_height = static_cast<std::uint32_t>(options.font_size_px * 1.6f);
    const std::uint64_t rows = (count + layout.columns - 1) / layout.columns;
    const std::uint64_t gap = options.gap_px;
    layout.width = layout.columns * (layout.cell_width + gap) + gap;
    layout.height = rows * (layout.cell_height + layout.label_height + gap) + gap;
    return layout;
}

void appendBytes(void* context, void* data, int size_bytes) {
    const auto* begin = static_cast<const char*>(data);
    auto* out = static_cast<std::vector<char>*>(context);
    out->insert(out->end(), begin, begin + size_bytes);
}

} // namespace

Pixels::Pixels(std::uint32_t width_px, std::uint32_t height_px, Rgba8 fill)
    : width(width_px), height(height_px) {
    rgba.resize(std::size_t(4) * width * height);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        rgba[i] = fill[i % 4];
}

Rgba8 Pixels::at(std::uint32_t x, std::uint32_t y) const {
    assert(x < width && y < height);
    const std::uint8_t* p = &rgba[std::size_t(4) * (std::size_t(y) * width + x)];
    return {p[0], p[1], p[2], p[3]};
}

void Pixels::set(std::uint32_t x, std::uint32_t y, Rgba8 color) {
    assert(x < width && y < height);
    std::copy(color.begin(), color.end(), &rgba[std::size_t(4) * (std::size_t(y) * width + x)]);
}

std::uint32_t sheetColumns(std::uint32_t pictures) {
    if (pictures <= 3)
        return std::max(pictures, 1u);
    return static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(pictures))));
}

Result<Pixels> composeSheet(std::span<const SheetCell> cells, const SheetOptions& options) {
    const SheetLayout layout = layOut(cells, options);
    if (layout.width > kMaxSide || layout.height > kMaxSide)
        return fail(ErrorKind::Usage,
                    "sheet of " + std::to_string(layout.width) + " x " +
                        std::to_string(layout.height) + " px is beyond " +
                        std::to_string(kMaxSide) + " px; use fewer or smaller pictures");
    Result<LabelFont> font = tl::unexpected(Error{});
    if (layout.label_height > 0) {
        font = LabelFont::open(options.font, options.font_size_px);
        if (!font)
            return tl::unexpected(font.error());
    }
    Pixels sheet(static_cast<std::uint32_t>(layout.width),
                 static_cast<std::uint32_t>(layout.height),
                 options.background);
    const std::uint32_t gap = options.gap_px;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        const auto column = static_cast<std::uint32_t>(i % layout.columns);
        const auto row = static_cast<std::uint32_t>(i / layout.columns);
        const std::uint32_t left = gap + column * (layout.cell_width + gap);
        const std::uint32_t top = gap + row * (layout.cell_height + layout.label_height + gap);
        const Pixels& picture = cells[i].picture;
        paste(sheet,
              picture,
              left + (layout.cell_width - picture.width) / 2,
              top + (layout.cell_height - picture.height) / 2);
        if (!font)
            continue;
        const std::vector<std::uint32_t> text = decodeUtf8(cells[i].label);
        const std::uint32_t width = std::min(font->width(text), layout.cell_width);
        font->draw(sheet,
                   text,
                   {left + (layout.cell_width - width) / 2,
                    top + layout.cell_height + layout.label_height / 6},
                   options.text);
    }
    return sheet;
}

Result<void> writePng(const std::filesystem::path& path, const Pixels& pixels) {
    if (pixels.empty())
        return fail(ErrorKind::Failed, quoted(path) + ": there is no picture to write");
    std::vector<char> bytes;
    if (stbi_write_png_to_func(appendBytes,
                               &bytes,
                               static_cast<int>(pixels.width),
                               static_cast<int>(pixels.height),
                               4,
                               pixels.rgba.data(),
                               static_cast<int>(pixels.width * 4)) == 0)
        return fail(ErrorKind::Failed, quoted(path) + ": the picture cannot be encoded");
    std::filesystem::path temporary = path;
    temporary += ".part";
    std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    std::error_code code;
    if (file)
        std::filesystem::rename(temporary, path, code);
    if (!file || code) {
        std::error_code ignored;
        std::filesystem::remove(temporary, ignored);
        return fail(ErrorKind::Failed,
                    quoted(path) +
                        " cannot be written; check the folder, its rights and the free space");
    }
    return {};
}

} // namespace lodestone
