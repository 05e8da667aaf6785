#include "ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui_stdlib.h>

namespace lodestone::ui {

namespace {

constexpr float kControlHeight = 26.0f;
constexpr float kSegmentHeight = 22.0f;
constexpr float kSegmentPadding = 9.0f;

float textTop(float control_top, float control_height) {
    return control_top + (control_height - ImGui::GetTextLineHeight()) * 0.5f;
}

ImVec2 buttonSize(const Ui& ui, std::string_view label, float width, ImFont* font) {
    const float natural = textWidth(ui, label, font) + ui.px(24);
    return {width > 0 ? width : natural, ui.px(kControlHeight)};
}

} // namespace

float segmentedWidth(const Ui& ui, std::span<const std::string_view> items) {
    float width = ui.px(2);
    for (const std::string_view item : items)
        width += textWidth(ui, item) + 2 * ui.px(kSegmentPadding);
    return width;
}

std::optional<int> segmented(const Ui& ui, const SegmentedSpec& spec) {
    std::optional<int> chosen;
    const ImVec2 min = ImGui::GetCursorScreenPos();
    const float natural = segmentedWidth(ui, spec.items);
    const float width = spec.width > 0 ? spec.width : natural;
    const float height = ui.px(kSegmentHeight);
    const float extra = std::max(0.0f, width - natural) /
                        static_cast<float>(std::max<std::size_t>(1, spec.items.size()));
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRect(
        min, {min.x + width, min.y + height}, color::kHairline, ui.px(4), 0, ui.theme.hairline());
    const std::string id(spec.label);
    ImGui::PushID(id.c_str());
    float x = min.x + ui.px(1);
    for (std::size_t at = 0; at < spec.items.size(); ++at) {
        const auto index = static_cast<int>(at);
        const std::string_view item = spec.items[at];
        const float item_width = textWidth(ui, item) + 2 * ui.px(kSegmentPadding) + extra;
        ImGui::SetCursorScreenPos({x, min.y + ui.px(1)});
        ImGui::PushID(index);
        if (ImGui::InvisibleButton("segment", {item_width, height - ui.px(2)}) &&
            index != spec.selected)
            chosen = index;
        ImGui::PopID();
        ui.record(id + "/" + std::string(item));
        if (at < spec.tooltips.size())
            tooltip(ui, spec.tooltips[at]);
        const bool lit = index == spec.selected;
        if (lit)
            list.AddRectFilled(
                ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), color::kFieldActive, ui.px(3));
        const ImU32 ink = lit || ImGui::IsItemHovered() ? color::kText : color::kSecondary;
        drawText(ui,
                 {x + item_width * 0.5f, textTop(min.y, height)},
                 Align::Center,
                 item,
                 {nullptr, ink});
        x += item_width;
    }
    ImGui::PopID();
    ImGui::SetCursorScreenPos(min);
    ImGui::Dummy({width, height});
    return chosen;
}

bool primaryButton(const Ui& ui, std::string_view label, float width) {
    const std::string id(label);
    const ImVec2 min = ImGui::GetCursorScreenPos();
    ImVec2 size = buttonSize(ui, label, width, ui.theme.fonts.semibold);
    size.y = ui.px(30);
    const bool pressed = ImGui::InvisibleButton(id.c_str(), size);
    ui.record(label);
    const bool enabled = ImGui::GetStyle().Alpha > 0.99f;
    const ImU32 fill = !enabled                 ? color::kField
                       : ImGui::IsItemActive()  ? color::kAccentActive
                       : ImGui::IsItemHovered() ? color::kAccentHovered
                                                : color::kAccent;
    ImGui::GetWindowDrawList()->AddRectFilled(min, min + size, fill, ui.px(4));
    drawText(ui,
             {min.x + size.x * 0.5f, textTop(min.y, size.y)},
             Align::Center,
             label,
             {ui.theme.fonts.semibold, enabled ? color::kOnAccent : color::kSecondary});
    return pressed;
}

bool button(const Ui& ui, std::string_view label, float width) {
    const std::string id(label);
    const bool pressed = ImGui::Button(id.c_str(), buttonSize(ui, label, width, nullptr));
    ui.record(label);
    return pressed;
}

bool linkButton(const Ui& ui, std::string_view label, ImU32 colour) {
    const std::string id(label);
    const ImVec2 min = ImGui::GetCursorScreenPos();
    const ImVec2 size{textWidth(ui, label), ImGui::GetTextLineHeight()};
    const bool pressed = ImGui::InvisibleButton(id.c_str(), size);
    ui.record(label);
    drawText(ui, min, Align::Left, label, {nullptr, colour});
    if (ImGui::IsItemHovered())
        horizontalHairline(ui, min.x, min.x + size.x, min.y + size.y - ui.px(1));
    return pressed;
}

bool toggle(const Ui& ui, std::string_view label, bool& value) {
    const std::string id(label);
    const ImVec2 min = ImGui::GetCursorScreenPos();
    const float box = ui.px(16);
    const ImVec2 size{box + ui.px(8) + textWidth(ui, label),
                      std::max(box, ImGui::GetTextLineHeight())};
    const bool pressed = ImGui::InvisibleButton(id.c_str(), size);
    ui.record(label);
    if (pressed)
        value = !value;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 top{min.x, std::round(min.y + (size.y - box) * 0.5f)};
    const ImU32 fill = value                    ? color::kAccent
                       : ImGui::IsItemHovered() ? color::kFieldHovered
                                                : color::kField;
    list.AddRectFilled(top, {top.x + box, top.y + box}, fill, ui.px(4));
    if (value) {
        const ImVec2 tick[] = {{top.x + box * 0.25f, top.y + box * 0.52f},
                               {top.x + box * 0.43f, top.y + box * 0.70f},
                               {top.x + box * 0.76f, top.y + box * 0.32f}};
        list.AddPolyline(tick, 3, color::kOnAccent, ImDrawFlags_None, ui.px(2));
    }
    drawText(ui, {min.x + box + ui.px(8), textTop(min.y, size.y)}, Align::Left, label);
    return pressed;
}

void closeOnEscape() {
    if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false))
        ImGui::CloseCurrentPopup();
}

std::optional<int>
combo(const Ui& ui, std::string_view label, std::span<const std::string> items, int selected) {
    std::optional<int> chosen;
    const std::string id = "##" + std::string(label);
    const bool known = selected >= 0 && selected < static_cast<int>(items.size());
    const float width = ImGui::GetContentRegionAvail().x;
    const std::string preview =
        known ? fitText(ui, items[static_cast<std::size_t>(selected)], width - ui.px(32))
              : std::string();
    ImGui::SetNextItemWidth(width);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.px(8), ui.px(5)});
    const ImVec2 min = ImGui::GetCursorScreenPos();
    const bool open = ImGui::BeginCombo(
        id.c_str(), preview.c_str(), ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLarge);
    const float height = ImGui::GetFrameHeight();
    ImGui::PopStyleVar();
    if (!open)
        ui.record(label);
    const ImVec2 arrow{min.x + width - ui.px(13), min.y + height * 0.5f};
    const float half = ui.px(4);
    if (open) {
        closeOnEscape();
        for (std::size_t at = 0; at < items.size(); ++at) {
            const bool is_selected = static_cast<int>(at) == selected;
            if (ImGui::Selectable(items[at].c_str(), is_selected) && !is_selected)
                chosen = static_cast<int>(at);
            ui.record(std::string(label) + "/" + items[at]);
        }
        ImGui::EndCombo();
    }
    ImGui::GetWindowDrawList()->AddTriangleFilled({arrow.x - half, arrow.y - half * 0.5f},
                                                  {arrow.x + half, arrow.y - half * 0.5f},
                                                  {arrow.x, arrow.y + half * 0.7f},
                                                  color::kSecondary);
    return chosen;
}

bool textField(const Ui& ui, std::string_view label, std::string& text, float width) {
    const std::string id = "##" + std::string(label);
    ImGui::SetNextItemWidth(width);
    const bool confirmed =
        ImGui::InputText(id.c_str(), &text, ImGuiInputTextFlags_EnterReturnsTrue);
    ui.record(label);
    return confirmed;
}

bool menuItem(
    const Ui& ui, std::string_view label, const char* shortcut, bool selected, bool enabled) {
    const std::string id(label);
    const bool chosen = ImGui::MenuItem(id.c_str(), shortcut, selected, enabled);
    ui.record(label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), enabled);
    return chosen;
}

void beginPanel(const char* name, const ImVec2& position, const ImVec2& size, PanelScroll scroll) {
    ImGui::SetNextWindowPos(position);
    ImGui::SetNextWindowSize(size);
    ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                             ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoNav |
                             ImGuiWindowFlags_NoBringToFrontOnFocus;
    if (scroll == PanelScroll::Vertical)
        flags &= ~ImGuiWindowFlags_NoScrollbar;
    else
        flags |= ImGuiWindowFlags_NoScrollWithMouse;
    ImGui::Begin(name, nullptr, flags);
}

void endPanel() {
    ImGui::End();
}

} // namespace lodestone::ui
