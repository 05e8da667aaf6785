#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone::ui {

namespace {

// Ratio along x, the logarithm of the size along y.
struct Axes {
    Area plot;
    double low = 0.0;  // log10 of bytes at the bottom
    double high = 1.0; // at the top

    float x(double ratio) const {
        return plot.position.x + plot.size.x * static_cast<float>(std::clamp(ratio, 0.0, 1.0));
    }

    float y(double size_bytes) const {
        const double along = (std::log10(std::max(1.0, size_bytes)) - low) / (high - low);
        return plot.end().y - plot.size.y * static_cast<float>(std::clamp(along, 0.0, 1.0));
    }
};

double originalBytes(const Document& document) {
    for (const Lane& lane : document.lanes)
        if (!lane.settings.algorithm)
            return static_cast<double>(lane.status.numbers.predicted_bytes);
    return 0.0;
}

// Spans all curves, with a margin. False if there is none yet.
bool fitAxes(const PanelInput& input, const WindowState& state, Axes& axes) {
    double smallest = std::numeric_limits<double>::max();
    double largest = 0.0;
    for (const Lane& lane : input.document.lanes)
        for (const SizePoint& point : state.curves.of(lane.id)) {
            smallest = std::min(smallest, point.size_bytes);
            largest = std::max(largest, point.size_bytes);
        }
    if (largest <= 0.0)
        return false;
    largest = std::max(largest, originalBytes(input.document));
    axes.low = std::log10(std::max(1.0, smallest)) - 0.1;
    axes.high = std::max(axes.low + 0.5, std::log10(largest) + 0.1);
    return true;
}

// A line for each power of ten that the axis spans, at binary-friendly sizes.
void drawGrid(const Ui& ui, const Axes& axes) {
    const TextStyle style{ui.theme.fonts.small, color::kSecondary};
    constexpr double kKib = 1024.0;
    float last_y = std::numeric_limits<float>::max();
    for (double unit = 1.0; unit < 1e15; unit *= kKib)
        for (double step = unit; step < unit * 999.0; step *= 10.0) {
            const double place = std::log10(step);
            const float y = axes.y(step);
            if (place < axes.low || place > axes.high || last_y - y < ui.px(14))
                continue;
            last_y = y;
            horizontalHairline(ui, axes.plot.position.x, axes.plot.end().x, y);
            drawText(ui,
                     {axes.plot.position.x - ui.px(6), y - ui.px(7)},
                     Align::Right,
                     formatBytes(static_cast<std::uint64_t>(step)),
                     style);
        }
    const float below = axes.plot.end().y + ui.px(4);
    drawText(ui, {axes.plot.position.x, below}, Align::Left, "0", style);
    drawText(ui, {axes.plot.end().x, below}, Align::Right, "triangles 100 %", style);
}

void drawOriginal(const Ui& ui, const Axes& axes, double size_bytes) {
    if (size_bytes <= 0.0)
        return;
    const float y = std::round(axes.y(size_bytes)) + 0.5f;
    const float dash = ui.px(4);
    for (float x = axes.plot.position.x; x < axes.plot.end().x; x += 2 * dash)
        ImGui::GetWindowDrawList()->AddLine(
            {x, y}, {std::min(x + dash, axes.plot.end().x), y}, color::kText, ui.theme.hairline());
}

void drawCurve(const Ui& ui, const Axes& axes, const Lane& lane, const SizeCurve& curve) {
    std::vector<ImVec2> points;
    for (const SizePoint& point : curve)
        points.emplace_back(axes.x(point.ratio), axes.y(point.size_bytes));
    const ImU32 colour = packed(lane.settings.colour);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, ui.px(1.6f));
    if (lane.status.lod) {
        const LaneNumbers& numbers = lane.status.numbers;
        list.AddCircleFilled(
            {axes.x(numbers.ratio), axes.y(static_cast<double>(numbers.predicted_bytes))},
            ui.px(3.5f),
            colour,
            20);
    }
}

// Size on a curve at a ratio, between its points; negative outside.
double sizeAt(const SizeCurve& curve, double ratio) {
    for (std::size_t at = 1; at < curve.size(); ++at) {
        const SizePoint& a = curve[at - 1];
        const SizePoint& b = curve[at];
        if (ratio < a.ratio || ratio > b.ratio)
            continue;
        return a.size_bytes +
               (b.size_bytes - a.size_bytes) * (ratio - a.ratio) / (b.ratio - a.ratio);
    }
    return -1.0;
}

// Under the mouse: a line and what each lane would weigh there.
void drawReading(const Ui& ui,
                 const PanelInput& input,
                 const WindowState& state,
                 const Axes& axes) {
    const float x = ImGui::GetIO().MousePos.x;
    const double ratio = static_cast<double>((x - axes.plot.position.x) / axes.plot.size.x);
    if (ratio < 0.0 || ratio > 1.0)
        return;
    verticalHairline(ui, x, axes.plot.position.y, axes.plot.end().y);
    ImGui::BeginTooltip();
    ImGui::TextDisabled("%s of the triangles", formatRatio(ratio).c_str());
    for (const Lane& lane : input.document.lanes) {
        const double size_bytes = sizeAt(state.curves.of(lane.id), ratio);
        if (size_bytes < 0.0)
            continue;
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled(
            at + ImVec2(ui.px(4), ui.px(8)), ui.px(4), packed(lane.settings.colour), 20);
        const std::string name(laneName(lane.settings));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ui.px(16));
        ImGui::Text(
            "%s  %s", name.c_str(), formatBytes(static_cast<std::uint64_t>(size_bytes)).c_str());
    }
    ImGui::EndTooltip();
}

} // namespace

void drawSizeChart(const Ui& ui,
                   const PanelInput& input,
                   const WindowState& state,
                   const Area& area) {
    const float labels = ui.px(56);
    Axes axes;
    axes.plot = {{area.position.x + labels, area.position.y + ui.px(18)},
                 {std::max(1.0f, area.size.x - labels), std::max(1.0f, area.size.y - ui.px(36))}};
    drawText(ui,
             {axes.plot.position.x, area.position.y},
             Align::Left,
             "projected size, log",
             {ui.theme.fonts.small, color::kSecondary});
    if (!fitAxes(input, state, axes))
        return;
    drawGrid(ui, axes);
    drawOriginal(ui, axes, originalBytes(input.document));
    for (const Lane& lane : input.document.lanes)
        drawCurve(ui, axes, lane, state.curves.of(lane.id));
    ImGui::SetCursorScreenPos(axes.plot.position);
    ImGui::InvisibleButton("chart", axes.plot.size);
    ui.record("chart");
    if (ImGui::IsItemHovered())
        drawReading(ui, input, state, axes);
}

} // namespace lodestone::ui
