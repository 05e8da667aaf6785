#include "ui/legend.h"

#include "app/scene_texels.h"
#include "ui/format.h"

#include <algorithm>
#include <cstdio>

namespace lodestone::ui {

namespace {

std::string shortNumber(double value) {
    if (value >= 1000.0)
        return formatCount(static_cast<std::uint64_t>(std::min(value, 1e15)));
    char text[32] = "";
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
}

// Where text over a picture stays readable on every background.
void plate(const Ui& ui, const ImVec2& min, const ImVec2& max) {
    ImGui::GetWindowDrawList()->AddRectFilled(min, max, IM_COL32(0x14, 0x17, 0x1b, 0xc8), ui.px(4));
}

// In a low view, where a scale at full size would hide the model.
bool isLow(const Ui& ui, const Area& area) {
    return area.size.y < ui.px(160);
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
               textWidth(ui, scale.unit, font) + 5 * gap;
    };
    const bool low = isLow(ui, area);
    const float margin = ui.px(low ? 2 : 8);
    const float room = area.size.x - 2 * margin;
    float bar = ui.px(low ? 64 : 96);
    if (low || bar + words() > room)
        scale.unit = scale.short_unit;
    bar = std::min(bar, room - words());
    if (bar < ui.px(32))
        return;
    const float width = bar + words();
    const float height = ui.px(low ? 15 : 20);
    const float bar_height = ui.px(low ? 5 : 8);
    const ImVec2 min{low ? area.end().x - width - margin
                         : area.position.x + (area.size.x - width) * 0.5f,
                     area.end().y - height - margin};
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
    const float top = min.y + (height - bar_height) * 0.5f;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (std::size_t at = 0; at + 1 < colors.size(); ++at) {
        const ImU32 left = IM_COL32(colors[at][0], colors[at][1], colors[at][2], 255);
        const ImU32 right = IM_COL32(colors[at + 1][0], colors[at + 1][1], colors[at + 1][2], 255);
        const float begin = x + step * static_cast<float>(at);
        list.AddRectFilledMultiColor(
            {begin, top}, {begin + step, top + bar_height}, left, right, right, left);
    }
    ui.record("legend", {x, top}, {x + bar, top + bar_height}, true);
    x += bar + gap;
    put(scale.high, color::kText);
    put(scale.unit, color::kSecondary);
}

// low_text: where the view is low.
void drawNumber(const Ui& ui, std::string_view text, std::string_view low_text, const Area& area) {
    const bool low = isLow(ui, area);
    const ImVec2 min =
        area.position + (low ? ImVec2(ui.px(2), ui.px(2)) : ImVec2(ui.px(8), ui.px(6)));
    const ImVec2 max = drawOnPlate(ui,
                                   min,
                                   Align::Left,
                                   low ? low_text : text,
                                   {low ? ui.theme.fonts.small : nullptr, color::kText});
    ui.record("number", min, max, true);
}

// Texels a unit where they are known: of the original, and of atlases that were made; else 0.
double texelsOf(const Document& document, const Lane& lane) {
    if (lane.status.textures)
        return lane.status.textures->baked.texels_per_unit;
    return lane.settings.algorithm ? 0.0 : document.texels_per_unit;
}

void drawShadingLegend(const Ui& ui, const Document& document, const Lane& lane, const Area& area) {
    const ColorMap map = document.view.colors;
    if (document.view.shading == ShadingMode::LodState)
        drawScale(ui, {"all", "0.1 %", "of its triangles left", "left"}, map, area);
    if (document.view.shading != ShadingMode::Texels)
        return;
    if (document.texels_per_unit <= 0.0) {
        drawNumber(ui, "nothing has a texture", "no texture", area);
        return;
    }
    const double full = texelsFull(document.texels_per_unit);
    drawScale(ui,
              {shortNumber(full / kTexelSpan),
               shortNumber(full),
               "texels a unit, logarithmic",
               "texels a unit"},
              map,
              area);
    if (const double texels = texelsOf(document, lane); texels > 0.0)
        drawNumber(ui, shortNumber(texels) + " texels a unit", shortNumber(texels), area);
}

} // namespace

ImVec2 drawOnPlate(const Ui& ui,
                   const ImVec2& position,
                   Align align,
                   std::string_view text,
                   const TextStyle& style) {
    const float line = style.font ? style.font->FontSize : ImGui::GetFontSize();
    const ImVec2 size{textWidth(ui, text, style.font) + ui.px(12),
                      std::min(ui.px(20), line + ui.px(6))};
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
        const std::string peak = "\u2264 " + formatError(lane.status.error_map.peak) + " %";
        if (lane.settings.algorithm)
            drawNumber(ui, "99.5 % " + peak, peak, area);
    }
    if (document.view.compare == CompareMode::Grid)
        drawShadingLegend(ui, document, lane, area);
    if (document.view.compare == CompareMode::Difference && lane.settings.algorithm) {
        drawScale(ui, {"same", "1", "FLIP, image difference", "FLIP"}, map, area);
        if (lane.status.flip)
            drawNumber(
                ui, "FLIP " + shortNumber(*lane.status.flip), shortNumber(*lane.status.flip), area);
    }
}

} // namespace lodestone::ui
