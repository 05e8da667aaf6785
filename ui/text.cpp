#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr float kTitleTracking = 0.9f; // design pixels between the letters of a section title

const char* endOf(std::string_view text) {
    return text.data() + text.size();
}

float fontSize(const ImFont& font) {
    return font.FontSize * ImGui::GetIO().FontGlobalScale;
}

ImFont& fontOr(const Ui& ui, ImFont* font) {
    return font ? *font : *ui.theme.fonts.regular;
}

std::string raised(std::string_view text) {
    std::string upper(text);
    std::transform(upper.begin(), upper.end(), upper.begin(), [](char letter) {
        return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
    });
    return upper;
}

// Bytes of the UTF-8 character that begins with this byte.
std::size_t characterLength(char first) {
    const auto byte = static_cast<unsigned char>(first);
    if (byte < 0x80)
        return 1;
    return byte < 0xe0 ? 2 : byte < 0xf0 ? 3 : 4;
}

} // namespace

void Ui::record(std::string_view label) const {
    if (!ImGui::IsItemVisible()) // scrolled away: nobody can click it
        return;
    // A disabled item has its alpha lowered by BeginDisabled.
    record(
        label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), ImGui::GetStyle().Alpha > 0.99f);
}

void Ui::record(std::string_view label, const ImVec2& min, const ImVec2& max, bool enabled) const {
    if (!log.enabled())
        return;
    log.widget(
        panel + "/" + std::string(label), min.x, min.y, max.x - min.x, max.y - min.y, enabled);
}

float textWidth(const Ui& ui, std::string_view text, ImFont* font) {
    ImFont& used = fontOr(ui, font);
    return used.CalcTextSizeA(fontSize(used), 1e9f, 0.0f, text.data(), endOf(text)).x;
}

void drawText(const Ui& ui,
              const ImVec2& position,
              Align align,
              std::string_view text,
              const TextStyle& style) {
    ImFont& font = fontOr(ui, style.font);
    float x = position.x;
    if (align != Align::Left)
        x -= textWidth(ui, text, &font) * (align == Align::Right ? 1.0f : 0.5f);
    ImGui::GetWindowDrawList()->AddText(&font,
                                        fontSize(font),
                                        {std::round(x), std::round(position.y)},
                                        style.colour,
                                        text.data(),
                                        endOf(text));
}

std::string fitText(const Ui& ui, std::string_view text, float width, ImFont* font) {
    if (textWidth(ui, text, font) <= width)
        return std::string(text);
    std::string fitting;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t next = std::min(text.size(), at + characterLength(text[at]));
        std::string longer(text.substr(0, next));
        if (textWidth(ui, longer + "\u2026", font) > width)
            break;
        fitting = std::move(longer);
        at = next;
    }
    return fitting + "\u2026";
}

void sectionTitle(const Ui& ui, std::string_view text) {
    const std::string upper = raised(text);
    ImFont& font = *ui.theme.fonts.caps;
    ImVec2 pen = ImGui::GetCursorScreenPos();
    const ImVec2 begin = pen;
    for (std::size_t at = 0; at < upper.size();) {
        const std::size_t length = std::min(characterLength(upper[at]), upper.size() - at);
        const std::string_view letter(upper.data() + at, length);
        ImGui::GetWindowDrawList()->AddText(
            &font, fontSize(font), pen, color::kSecondary, letter.data(), endOf(letter));
        pen.x += textWidth(ui, letter, &font) + ui.px(kTitleTracking);
        at += length;
    }
    ImGui::Dummy({pen.x - begin.x, fontSize(font) + ui.px(4)});
}

void labelledValue(const Ui& ui,
                   std::string_view label,
                   std::string_view value,
                   std::string_view suffix) {
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const float right = begin.x + ImGui::GetContentRegionAvail().x;
    drawText(ui, begin, Align::Left, label, {nullptr, color::kSecondary});
    float value_right = right;
    if (!suffix.empty()) {
        ImFont* const small = ui.theme.fonts.small;
        drawText(ui, {right, begin.y + ui.px(2)}, Align::Right, suffix, {small, color::kSecondary});
        value_right -= textWidth(ui, suffix, small) + ui.px(4);
    }
    drawText(ui, {value_right, begin.y}, Align::Right, value, {ui.theme.fonts.semibold});
    ImGui::Dummy({right - begin.x, ImGui::GetTextLineHeight() + ui.px(3)});
}

void tooltip(const Ui& ui, std::string_view text) {
    if (text.empty() || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
        return;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(10), ui.px(8)});
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(ui.px(300));
    ImGui::TextUnformatted(text.data(), endOf(text));
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

void horizontalHairline(const Ui& ui, float x_begin, float x_end, float y) {
    const float top = std::round(y);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {x_begin, top}, {x_end, top + ui.theme.hairline()}, color::kHairline);
}

void verticalHairline(const Ui& ui, float x, float y_begin, float y_end) {
    const float left = std::round(x);
    ImGui::GetWindowDrawList()->AddRectFilled(
        {left, y_begin}, {left + ui.theme.hairline(), y_end}, color::kHairline);
}

void progressLine(const Ui& ui, const ImVec2& min, float width, double fraction, ImU32 colour) {
    const float height = ui.px(4);
    const float filled = width * static_cast<float>(std::clamp(fraction, 0.0, 1.0));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(min, {min.x + width, min.y + height}, color::kHairline, height * 0.5f);
    if (filled >= 1.0f)
        list.AddRectFilled(min, {min.x + filled, min.y + height}, colour, height * 0.5f);
}

void fadeWhereMore(const Ui& ui, ImU32 background) {
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY() - 1.0f)
        return;
    const ImVec2 begin = ImGui::GetWindowPos();
    const ImVec2 end = begin + ImGui::GetWindowSize();
    const ImU32 clear = background & 0x00ffffffu;
    const ImVec2 top{begin.x, end.y - ui.px(28)};
    ImGui::GetWindowDrawList()->AddRectFilledMultiColor(
        top,
        {end.x - ImGui::GetStyle().ScrollbarSize, end.y},
        clear,
        clear,
        background,
        background);
}

void spinner(const Ui& ui, const ImVec2& center, float radius, ImU32 colour) {
    constexpr float kTurnsPerSecond = 0.8f;
    constexpr float kTau = 6.2831853f;
    const float begin =
        static_cast<float>(std::fmod(ImGui::GetTime() * kTurnsPerSecond, 1.0)) * kTau;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PathArcTo(center, radius, begin, begin + kTau * 0.72f, 24);
    list.PathStroke(colour, ImDrawFlags_None, ui.px(2));
}

} // namespace lodestone::ui
