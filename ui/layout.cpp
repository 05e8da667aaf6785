#include "ui/panels.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

Layout layoutOf(const Theme& theme, const ImVec2& window_size, const LayoutNeeds& needs) {
    constexpr float kLowCompare = 168.0f; // in a window of kLowWindow
    constexpr float kLowWindow = 720.0f;
    constexpr float kShareOfMore = 0.36f; // of what the window is higher

    const auto px = [&](float design_px) { return std::round(theme.px(design_px)); };
    const float width = window_size.x;
    const float menu = px(30);
    const float status = px(24);
    const bool hidden = needs.panels_hidden;
    const float rows = px(36.0f + 29.0f * static_cast<float>(needs.lane_count));
    const float more = std::max(0.0f, window_size.y - px(kLowWindow));
    const float most = px(kLowCompare) + std::round(kShareOfMore * more);
    const float compare = hidden ? 0.0f : std::clamp(rows, px(kLowCompare), most);
    const float left = hidden ? 0.0f : px(212);
    const float right = hidden ? 0.0f : px(236);
    const float master = px(34);
    const float middle = std::max(1.0f, window_size.y - menu - status - compare);
    const float centre = std::max(1.0f, width - left - right);
    Layout layout;
    layout.menu = {{0, 0}, {width, menu}};
    layout.scene = {{0, menu}, {left, middle}};
    layout.master = {{left, menu}, {centre, master}};
    layout.grid = {{left, menu + master}, {centre, std::max(1.0f, middle - master)}};
    layout.inspector = {{width - right, menu}, {right, middle}};
    layout.compare = {{0, menu + middle}, {width, compare}};
    layout.status = {{0, window_size.y - status}, {width, status}};
    return layout;
}

} // namespace lodestone::ui
