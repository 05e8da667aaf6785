#include "ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <imgui_stdlib.h>
#include <utility>

namespace lodestone::ui {

namespace {

constexpr float kTrackHeight = 4.0f;
constexpr float kGrabRadius = 7.0f;
constexpr float kRowHeight = 16.0f;

void drawTrack(const Ui& ui, const SliderSpec& spec, const ImVec2& min, float width, bool lit) {
    const float radius = ui.px(kGrabRadius);
    const float height = ui.px(kTrackHeight);
    const float middle = std::round(min.y + ui.px(kRowHeight) * 0.5f);
    const float usable = std::max(1.0f, width - 2 * radius);
    const float place = min.x + radius + usable * static_cast<float>(spec.fraction);
    const ImU32 fill = spec.enabled ? spec.colour : color::kFaint;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 top{min.x, middle - height * 0.5f};
    list.AddRectFilled(top, {min.x + width, top.y + height}, color::kHairline, height * 0.5f);
    list.AddRectFilled(top, {place, top.y + height}, fill, height * 0.5f);
    if (lit)
        list.AddCircleFilled(
            {place, middle}, radius + ui.px(3), (fill & 0x00ffffffu) | 0x50000000u);
    list.AddCircleFilled(
        {place, middle}, radius, spec.enabled ? color::kText : color::kSecondary, 32);
}

// The value at the right of the label; a click turns it into a text field.
void editableValue(const Ui& ui, const SliderSpec& spec, float right, SliderEvent& event) {
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const ImGuiID field = ImGui::GetID("value");
    WidgetState& state = ui.widgets;
    const float line = ImGui::GetTextLineHeight();
    if (state.typed_field == field) {
        ImGui::SetCursorScreenPos({right - ui.px(96), begin.y - ui.px(2)});
        ImGui::SetNextItemWidth(ui.px(96));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.px(6), ui.px(2)});
        if (std::exchange(state.wants_focus, false))
            ImGui::SetKeyboardFocusHere();
        if (ImGui::InputText("##value",
                             &state.text,
                             ImGuiInputTextFlags_EnterReturnsTrue |
                                 ImGuiInputTextFlags_AutoSelectAll))
            event.typed = state.text;
        ImGui::PopStyleVar();
        ui.record(std::string(spec.label) + " field");
        if (event.typed || ImGui::IsItemDeactivated())
            state.typed_field = 0;
        return;
    }
    const float width = textWidth(ui, spec.value, ui.theme.fonts.semibold);
    drawText(ui, {right, begin.y}, Align::Right, spec.value, {ui.theme.fonts.semibold});
    if (spec.edit_text.empty())
        return;
    ImGui::SetCursorScreenPos({right - width, begin.y});
    if (ImGui::InvisibleButton("edit", {std::max(1.0f, width), line})) {
        state.typed_field = field;
        state.wants_focus = true;
        state.text = spec.edit_text;
    }
    ui.record(std::string(spec.label) + " value");
    if (ImGui::IsItemHovered())
        horizontalHairline(ui, right - width, right, begin.y + line);
    tooltip(ui, "Click to type a value.");
}

} // namespace

SliderEvent sliderTrack(const Ui& ui, const SliderSpec& spec, float width) {
    SliderEvent event;
    const std::string id(spec.label);
    ImGui::PushID(id.c_str());
    const ImVec2 min = ImGui::GetCursorScreenPos();
    ImGui::InvisibleButton("track", {std::max(1.0f, width), ui.px(kRowHeight)});
    const bool active = spec.enabled && ImGui::IsItemActive();
    event.drag = ImGui::GetID("track");
    if (active && !ui.widgets.drag_cancelled) {
        const float radius = ui.px(kGrabRadius);
        const double fraction = static_cast<double>(ImGui::GetIO().MousePos.x - min.x - radius) /
                                static_cast<double>(std::max(1.0f, width - 2 * radius));
        event.fraction = std::clamp(fraction, 0.0, 1.0);
        if (*event.fraction == spec.fraction)
            event.fraction.reset();
    }
    event.released = spec.enabled && ImGui::IsItemDeactivated();
    ui.record(spec.label, ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), spec.enabled);
    const bool hovered = ImGui::IsItemHovered();
    tooltip(ui, active ? std::string_view() : spec.tooltip);
    SliderSpec drawn = spec;
    drawn.fraction = std::clamp(event.fraction.value_or(spec.fraction), 0.0, 1.0);
    drawTrack(ui, drawn, min, width, spec.enabled && (hovered || active));
    ImGui::PopID();
    return event;
}

SliderEvent slider(const Ui& ui, const SliderSpec& spec) {
    SliderEvent typed;
    const std::string id(spec.label);
    ImGui::PushID(id.c_str());
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    drawText(ui, begin, Align::Left, spec.label, {nullptr, color::kSecondary});
    editableValue(ui, spec, begin.x + width, typed);
    ImGui::PopID();
    ImGui::SetCursorScreenPos({begin.x, begin.y + ImGui::GetTextLineHeight() + ui.px(1)});
    SliderEvent event = sliderTrack(ui, spec, width);
    event.typed = std::move(typed.typed);
    return event;
}

} // namespace lodestone::ui
