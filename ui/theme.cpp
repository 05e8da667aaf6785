#include "ui/theme.h"

#include "ui/fonts.h"

#include <array>
#include <utility>

namespace lodestone::ui {

namespace {

ImVec4 vec(ImU32 packed) {
    return ImGui::ColorConvertU32ToFloat4(packed);
}

void setColors(ImGuiStyle& style) {
    constexpr std::array kColors = {
        std::pair{ImGuiCol_Text, color::kText},
        std::pair{ImGuiCol_TextDisabled, color::kSecondary},
        std::pair{ImGuiCol_WindowBg, color::kPanel},
        std::pair{ImGuiCol_ChildBg, IM_COL32_BLACK_TRANS},
        std::pair{ImGuiCol_PopupBg, color::kPopup},
        std::pair{ImGuiCol_Border, color::kHairline},
        std::pair{ImGuiCol_FrameBg, color::kField},
        std::pair{ImGuiCol_FrameBgHovered, color::kFieldHovered},
        std::pair{ImGuiCol_FrameBgActive, color::kFieldActive},
        std::pair{ImGuiCol_MenuBarBg, color::kPanel},
        std::pair{ImGuiCol_ScrollbarBg, IM_COL32_BLACK_TRANS},
        std::pair{ImGuiCol_ScrollbarGrab, color::kFieldHovered},
        std::pair{ImGuiCol_ScrollbarGrabHovered, color::kFieldActive},
        std::pair{ImGuiCol_ScrollbarGrabActive, color::kFaint},
        std::pair{ImGuiCol_CheckMark, color::kAccent},
        std::pair{ImGuiCol_SliderGrab, color::kText},
        std::pair{ImGuiCol_SliderGrabActive, color::kText},
        std::pair{ImGuiCol_Button, color::kField},
        std::pair{ImGuiCol_ButtonHovered, color::kFieldHovered},
        std::pair{ImGuiCol_ButtonActive, color::kFieldActive},
        std::pair{ImGuiCol_Header, color::kSelection},
        std::pair{ImGuiCol_HeaderHovered, color::kFieldHovered},
        std::pair{ImGuiCol_HeaderActive, color::kFieldActive},
        std::pair{ImGuiCol_Separator, color::kHairline},
        std::pair{ImGuiCol_TableBorderLight, color::kHairline},
        std::pair{ImGuiCol_TableBorderStrong, color::kHairline},
        std::pair{ImGuiCol_TableHeaderBg, IM_COL32_BLACK_TRANS},
        std::pair{ImGuiCol_TextSelectedBg, IM_COL32(0x4c, 0xc2, 0xa0, 0x50)},
        std::pair{ImGuiCol_NavHighlight, color::kAccent},
        std::pair{ImGuiCol_ModalWindowDimBg, IM_COL32(0x0c, 0x0e, 0x11, 0xa8)},
    };
    for (const auto& [slot, packed] : kColors)
        style.Colors[slot] = vec(packed);
}

void setMetrics(ImGuiStyle& style, float scale) {
    style.WindowPadding = {12, 8};
    style.FramePadding = {8, 4};
    style.CellPadding = {8, 4};
    style.ItemSpacing = {8, 6};
    style.ItemInnerSpacing = {6, 4};
    style.IndentSpacing = 16;
    style.ScrollbarSize = 10;
    style.GrabMinSize = 10;
    style.WindowBorderSize = 0;
    style.ChildBorderSize = 0;
    style.PopupBorderSize = 1;
    style.FrameBorderSize = 0;
    style.WindowRounding = 0;
    style.ChildRounding = 4;
    style.FrameRounding = 4;
    style.PopupRounding = 4;
    style.ScrollbarRounding = 4;
    style.GrabRounding = 4;
    style.WindowMinSize = {16, 16};
    style.AntiAliasedLinesUseTex = true;
    style.ScaleAllSizes(scale);
}

} // namespace

Theme applyTheme(float scale, float density) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    setColors(style);
    setMetrics(style, scale);
    Theme theme;
    theme.scale = scale;
    theme.fonts = loadFonts(scale * density);
    ImGui::GetIO().FontGlobalScale = 1.0f / density;
    return theme;
}

} // namespace lodestone::ui
