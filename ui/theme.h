#pragma once
// Colours, fonts and metrics of the window. Everything that has a size goes through Theme::px.
#include <imgui.h>

namespace lodestone::ui {

namespace color {
constexpr ImU32 kBackground = IM_COL32(0x14, 0x17, 0x1b, 0xff);
constexpr ImU32 kPanel = IM_COL32(0x1b, 0x1f, 0x24, 0xff);
constexpr ImU32 kView = IM_COL32(0x1a, 0x1e, 0x23, 0xff);
constexpr ImU32 kPopup = IM_COL32(0x1e, 0x22, 0x28, 0xff);
constexpr ImU32 kField = IM_COL32(0x26, 0x2b, 0x32, 0xff);
constexpr ImU32 kFieldHovered = IM_COL32(0x2d, 0x33, 0x3b, 0xff);
constexpr ImU32 kFieldActive = IM_COL32(0x32, 0x39, 0x42, 0xff);
constexpr ImU32 kHairline = IM_COL32(0x2a, 0x2f, 0x36, 0xff);
constexpr ImU32 kText = IM_COL32(0xe8, 0xea, 0xed, 0xff);
constexpr ImU32 kSecondary = IM_COL32(0x8a, 0x93, 0xa0, 0xff);
constexpr ImU32 kFaint = IM_COL32(0x5c, 0x64, 0x6f, 0xff);
constexpr ImU32 kAccent = IM_COL32(0x4c, 0xc2, 0xa0, 0xff);
constexpr ImU32 kAccentHovered = IM_COL32(0x5d, 0xd3, 0xb1, 0xff);
constexpr ImU32 kAccentActive = IM_COL32(0x42, 0xad, 0x8e, 0xff);
constexpr ImU32 kSelection = IM_COL32(0x1f, 0x2b, 0x2b, 0xff);
constexpr ImU32 kOnAccent = IM_COL32(0x10, 0x24, 0x1e, 0xff);
constexpr ImU32 kError = IM_COL32(0xe8, 0x6a, 0x6a, 0xff);
constexpr ImU32 kWarning = IM_COL32(0xe3, 0xa4, 0x4d, 0xff);
} // namespace color

struct Fonts {
    ImFont* regular = nullptr;  // 13 px
    ImFont* semibold = nullptr; // 13 px
    ImFont* small = nullptr;    // 11 px
    ImFont* caps = nullptr;     // 11 px semibold, for section titles
};

struct Theme {
    float scale = 1.0f; // window units per design pixel
    Fonts fonts;

    float px(float design_px) const { return design_px * scale; }

    // Never thinner than one pixel, never blurred over two.
    float hairline() const {
        return scale < 1.5f ? 1.0f : static_cast<float>(static_cast<int>(scale));
    }
};

// Sets style and fonts of the current ImGui context. Before the backends make the font texture.
// scale: window units per design pixel, 0.5..4. density: framebuffer pixels per window unit (2 on
// a Mac's display, 1 elsewhere); text is rasterised that much finer. Main thread.
Theme applyTheme(float scale, float density);

} // namespace lodestone::ui
