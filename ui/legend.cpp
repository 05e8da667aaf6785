#include "ui/legend.h"

#include "ui/format.h"

#include <algorithm>
#include <cstdio>

namespace lodestone::ui {

namespace {

std::string shortNumber(double value) {
    char text[32] = "";
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

// Where text over a picture stays readable on every background.
void plate(const Ui& ui, const ImVec2& min, const ImVec2& max) {
    ImGui::GetWindowDrawList()->AddRectFilled(min, max, IM_COL32(0x14, 0x17, 0x1b, 0xc8), ui.px(4));
}

struct Scale {
    std::string low;
    std::string high;
    std::string unit;
    std::string short_unit; // where there is no room for the other
};

// At the lower edge, in the middle.
void drawScale(const Ui& ui, Scale scale, ColorMap map, const Area& area) {
    ImFont* const font = ui.theme.fonts.small;
    const float gap = ui.px(6);
    const auto words = [&] {
        return textWidth(ui, scale.low, font) + textWidth(ui, scale.high, font) +
               textWidth(ui, scale.unit, font) + 4 * gap;
    };
    const float room = area.size.x - ui.px(16);
    float bar = ui.px(96);
    if (bar + words() > room)
        scale.unit = scale.short_unit;
    bar = std::min(bar, room - words());
    if (bar < ui.px(32))
        return;
    const float width = bar + words();
    const float height = ui.px(20);
    const ImVec2 min{area.position.x + (area.size.x - width) * 0.5f,
                     area.end().y - height - ui.px(8)};
    plate(ui, min, min + ImVec2(width, height));
    const float text_y = min.y + (height - font->FontSize) * 0.5f;
    float x = min.x + gap;
    const auto put = [&](std::string_view text, ImU32 ink) {
        drawText(ui, {x, text_y}, Align::Left, text, {font, ink});
        x += textWidth(ui, text, font) + gap;
    };
    put(scale.low, color::kText);
    const auto& colors = mapColors(map);
    const float step = bar / static_cast<float>(colors.size() - 1);
    const float top = min.y + ui.px(6);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t at = 0; at + 1 < colors.size(); ++at) {
        const ImU32 left = IM_COL32(colors[at][0], colors[at][1], colors[at][2], 255);
        const ImU32 right = IM_COL32(colors[at + 1][0], colors[at + 1][1], colors[at + 1][2], 255);
        const float begin = x + step * static_cast<float>(at);
        list.AddRectFilledMultiColor(
            {begin, top}, {begin + step, top + ui.px(8)}, left, right, right, left);
    }
    ui.record("legend", {x, top}, {x + bar, top + ui.px(8)}, true);
    x += bar + gap;
    put(scale.high, color::kText);
    put(scale.unit, color::kSecondary);
}

void drawNumber(const Ui& ui, std::string_view text, const Area& area) {
    const ImVec2 min = area.position + ImVec2(ui.px(8), ui.px(6));
    const ImVec2 max = drawOnPlate(ui, min, Align::Left, text, {});
    ui.record("number", min, max, true);
}

} // namespace

ImVec2 drawOnPlate(const Ui& ui,
                   const ImVec2& position,
                   Align align,
                   std::string_view text,
                   const TextStyle& style) {
    const float line = style.font ? style.font->FontSize : ImGui::GetFontSize();
    const ImVec2 size{textWidth(ui, text, style.font) + ui.px(12), ui.px(20)};
    const ImVec2 min{position.x - (align == Align::Center ? size.x * 0.5f : 0.0f), position.y};
    plate(ui, min, min + size);
    drawText(ui, {min.x + ui.px(6), min.y + (size.y - line) * 0.5f}, Align::Left, text, style);
    return min + size;
}

void drawLegend(const Ui& ui, const Document& document, const Lane& lane, const Area& area) {
    const ColorMap map = document.view.colors;
    if (document.view.compare == CompareMode::HeatMap && lane.status.error_map.lod) {
        const double full = errorMapFull(document);
        const double world = full * 0.01 * document.bounds.diagonal();
        drawScale(ui,
                  {"0",
                   shortNumber(full) + " %",
                   "of the diagonal \u00b7 " + shortNumber(world) + " units",
                   "of diag."},
                  map,
                  area);
        if (lane.settings.algorithm)
            drawNumber(ui, "99.5 % \u2264 " + formatError(lane.status.error_map.peak) + " %", area);
    }
    if (document.view.compare == CompareMode::Grid &&
        document.view.shading == ShadingMode::LodState)
        drawScale(ui, {"all", "0.1 %", "of its triangles left", "left"}, map, area);
    if (document.view.compare == CompareMode::Difference && lane.settings.algorithm) {
        drawScale(ui, {"same", "1", "FLIP, image difference", "FLIP"}, map, area);
        if (lane.status.flip)
            drawNumber(ui, "FLIP " + shortNumber(*lane.status.flip), area);
    }
}

} // namespace lodestone::ui
