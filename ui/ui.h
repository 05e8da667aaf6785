#pragma once
// What every panel gets: theme, log of widget rectangles, and where its commands go.
#include "app/commands.h"
#include "app/ui_log.h"
#include "ui/theme.h"

#include <string>
#include <string_view>

namespace lodestone::ui {

// What the window's own widgets remember between frames.
struct WidgetState {
    ImGuiID typed_field = 0; // the value that is being typed beside a slider; 0: none
    bool wants_focus = false;
    std::string text;
    bool drag_cancelled = false; // Esc was pressed: sliders stay until the mouse is released
};

struct Ui {
    const Theme& theme;
    UiLog& log;
    CommandQueue& commands;
    WidgetState& widgets;
    std::string panel; // prefix of every recorded name: "Inspector"

    float px(float design_px) const { return theme.px(design_px); }

    void push(Command command) const { commands.push(std::move(command)); }

    // Records the last ImGui item as "panel/label".
    void record(std::string_view label) const;
    // Records any rectangle as "panel/label".
    void record(std::string_view label, const ImVec2& min, const ImVec2& max, bool enabled) const;
};

inline ImVec2 operator+(const ImVec2& a, const ImVec2& b) {
    return {a.x + b.x, a.y + b.y};
}

inline ImVec2 operator-(const ImVec2& a, const ImVec2& b) {
    return {a.x - b.x, a.y - b.y};
}

inline ImU32 packed(const Rgb& colour) {
    return IM_COL32(colour.r, colour.g, colour.b, 255);
}

} // namespace lodestone::ui
