#include "ui/fonts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fontconfig/fontconfig.h>
#include <imgui_freetype.h>
#include <string>

namespace lodestone::ui {

namespace {

struct Family {
    const char* name;
    float line_em; // ascender - descender in em: ImGui sizes fonts by the line, design by the em
};

constexpr std::array<Family, 3> kFamilies = {{
    {"Inter", 1.2102f},
    {"Noto Sans", 1.362f},
    {"DejaVu Sans", 1.1641f},
}};

constexpr float kTextEm = 13.0f;
constexpr float kSmallEm = 11.0f;

// The file that holds a family at a weight; empty if the system lacks that family.
std::string findFont(const char* family, int weight) {
    FcPattern* const pattern = FcPatternCreate();
    FcPatternAddString(pattern, FC_FAMILY, reinterpret_cast<const FcChar8*>(family));
    FcPatternAddInteger(pattern, FC_WEIGHT, weight);
    FcPatternAddInteger(pattern, FC_SLANT, FC_SLANT_ROMAN);
    FcConfigSubstitute(nullptr, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcResult outcome = FcResultNoMatch;
    FcPattern* const match = FcFontMatch(nullptr, pattern, &outcome);
    FcPatternDestroy(pattern);
    if (!match)
        return {};
    FcChar8* file = nullptr;
    FcChar8* matched_family = nullptr;
    std::string path;
    if (FcPatternGetString(match, FC_FILE, 0, &file) == FcResultMatch &&
        FcPatternGetString(match, FC_FAMILY, 0, &matched_family) == FcResultMatch &&
        std::string(reinterpret_cast<const char*>(matched_family)) == family)
        path = reinterpret_cast<const char*>(file);
    FcPatternDestroy(match);
    return path;
}

// Latin, Greek and Cyrillic for file names; punctuation, arrows and signs that the window writes.
constexpr std::array<ImWchar, 21> kRanges = {0x0020, 0x017f, 0x0370, 0x052f, 0x2009, 0x2009, 0x2010,
                                             0x2027, 0x2030, 0x205e, 0x2070, 0x209f, 0x2190, 0x21ff,
                                             0x2200, 0x22ff, 0x25a0, 0x25ff, 0x2713, 0x2715, 0};

constexpr std::array<ImWchar, 9> kShortRanges = {
    0x0020, 0x00ff, 0x2009, 0x2009, 0x2010, 0x2027, 0x2190, 0x2193, 0};

// One advance for all ten digits, each centred in it.
void alignDigits(ImFont& font) {
    float widest = 0.0f;
    for (ImWchar digit = '0'; digit <= '9'; ++digit)
        widest = std::max(widest, font.GetCharAdvance(digit));
    for (ImWchar digit = '0'; digit <= '9'; ++digit) {
        auto* const glyph = const_cast<ImFontGlyph*>(font.FindGlyphNoFallback(digit));
        if (!glyph)
            continue;
        const float shift = std::round((widest - glyph->AdvanceX) * 0.5f);
        glyph->X0 += shift;
        glyph->X1 += shift;
        glyph->AdvanceX = widest;
        font.IndexAdvanceX[digit] = widest;
    }
    // Hinting leaves thin spaces, which group digits, hardly visible.
    constexpr ImWchar kThinSpace = 0x2009;
    if (auto* const space = const_cast<ImFontGlyph*>(font.FindGlyphNoFallback(kThinSpace))) {
        space->AdvanceX = std::max(space->AdvanceX, std::round(font.FontSize * 0.22f));
        font.IndexAdvanceX[kThinSpace] = space->AdvanceX;
    }
}

struct FontFiles {
    std::string regular;
    std::string semibold;
    float line_em = 1.0f;
};

FontFiles findFontFiles() {
    for (const Family& family : kFamilies) {
        std::string regular = findFont(family.name, FC_WEIGHT_REGULAR);
        if (regular.empty())
            continue;
        std::string semibold = findFont(family.name, FC_WEIGHT_DEMIBOLD);
        if (semibold.empty())
            semibold = regular;
        return {std::move(regular), std::move(semibold), family.line_em};
    }
    return {};
}

} // namespace

std::filesystem::path systemFontFile() {
    return findFontFiles().regular;
}

Fonts loadFonts(float scale) {
    ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
    atlas.Clear();
    atlas.FontBuilderIO = ImGuiFreeType::GetBuilderForFreeType();
    const FontFiles files = findFontFiles();
    Fonts fonts;
    if (!files.regular.empty()) {
        ImFontConfig config;
        config.FontBuilderFlags = ImGuiFreeTypeBuilderFlags_LightHinting;
        const float text_px = std::round(kTextEm * scale * files.line_em);
        const float small_px = std::round(kSmallEm * scale * files.line_em);
        const auto add = [&](const std::string& file, float size_px, const ImWchar* ranges) {
            return atlas.AddFontFromFileTTF(file.c_str(), size_px, &config, ranges);
        };
        fonts.regular = add(files.regular, text_px, kRanges.data());
        fonts.semibold = add(files.semibold, text_px, kRanges.data());
        fonts.small = add(files.regular, small_px, kRanges.data());
        fonts.caps = add(files.semibold, small_px, kShortRanges.data());
    }
    if (!fonts.regular || !fonts.semibold || !fonts.small || !fonts.caps || !atlas.Build()) {
        atlas.Clear();
        ImFontConfig config;
        config.SizePixels = std::round(kTextEm * scale);
        ImFont* const fallback = atlas.AddFontDefault(&config);
        fonts = {fallback, fallback, fallback, fallback};
        atlas.Build();
    }
    for (ImFont* const font : atlas.Fonts)
        alignDigits(*font);
    return fonts;
}

} // namespace lodestone::ui
