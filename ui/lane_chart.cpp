#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace lodestone::ui {

namespace {

constexpr double kSmallest = 1e-6;    // of a value that a logarithm is taken of
constexpr double kErrorDecades = 4.0; // errors below the largest that are told apart

// Ratio along x, the logarithm of a size or an error along y.
struct Axes {
    ChartKind kind = ChartKind::Size;
    Area plot;
    double low = 0.0;  // log10 of the value at the bottom
    double high = 1.0; // at the top

    float x(double ratio) const {
        return plot.position.x + plot.size.x * static_cast<float>(std::clamp(ratio, 0.0, 1.0));
    }

    float y(double value) const {
        const double along = (std::log10(std::max(kSmallest, value)) - low) / (high - low);
        return plot.end().y - plot.size.y * static_cast<float>(std::clamp(along, 0.0, 1.0));
    }

    double valueOf(const SizePoint& point) const {
        return kind == ChartKind::Size ? point.size_bytes : point.error_rel_percent;
    }

    // What the lane shows now.
    double valueOf(const LaneNumbers& numbers) const {
        return kind == ChartKind::Size ? static_cast<double>(numbers.kept_bytes)
                                       : numbers.error_estimate;
    }

    std::string text(double value) const {
        return kind == ChartKind::Size ? formatBytes(static_cast<std::uint64_t>(value))
                                       : formatError(value) + " %";
    }
};

double originalBytes(const Document& document) {
    for (const Lane& lane : document.lanes)
        if (!lane.settings.algorithm)
            return static_cast<double>(lane.status.numbers.predicted_bytes);
    return 0.0;
}

// Spans all curves and what lanes show, with a margin. False if there is nothing yet, or nothing
// that a logarithm shows.
bool fitAxes(const PanelInput& input, const WindowState& state, Axes& axes) {
    double smallest = std::numeric_limits<double>::max();
    double largest = 0.0;
    const auto include = [&](double value) {
        if (!std::isfinite(value)) // nobody knows: it stands at the upper edge
            return;
        largest = std::max(largest, value);
        if (value > kSmallest)
            smallest = std::min(smallest, value);
    };
    for (const Lane& lane : input.document.lanes) {
        for (const SizePoint& point : state.curves.of(lane.id))
            include(axes.valueOf(point));
        if (lane.status.lod)
            include(axes.valueOf(lane.status.numbers));
        if (axes.kind == ChartKind::Error && lane.status.distance)
            largest = std::max(largest, lane.status.distance->hausdorff);
    }
    if (largest <= kSmallest)
        return false;
    if (axes.kind == ChartKind::Size)
        largest = std::max(largest, originalBytes(input.document));
    else
        smallest = std::max(smallest, largest * std::pow(10.0, -kErrorDecades));
    axes.low = std::log10(std::max(kSmallest, smallest)) - 0.1;
    axes.high = std::max(axes.low + 0.5, std::log10(largest) + 0.1);
    return true;
}

void gridLine(const Ui& ui, const Axes& axes, double value, float& last_y) {
    const float y = axes.y(value);
    if (last_y - y < ui.px(14))
        return;
    last_y = y;
    horizontalHairline(ui, axes.plot.position.x, axes.plot.end().x, y);
    drawText(ui,
             {axes.plot.position.x - ui.px(6), y - ui.px(7)},
             Align::Right,
             axes.text(value),
             {ui.theme.fonts.small, color::kSecondary});
}

// The powers of ten that the axis spans, of sizes at binary-friendly ones, times each multiple;
// rising.
std::vector<double> gridValues(const Axes& axes, std::span<const double> multiples) {
    constexpr double kKib = 1024.0;
    std::vector<double> values;
    const auto add = [&](double power, double below) {
        for (const double multiple : multiples) {
            const double place = std::log10(power * multiple);
            if (power * multiple < below && place >= axes.low && place <= axes.high)
                values.push_back(power * multiple);
        }
    };
    if (axes.kind == ChartKind::Size)
        for (double unit = 1.0; unit < 1e15; unit *= kKib)
            for (double power = unit; power < unit * 999.0; power *= 10.0)
                add(power, unit * kKib);
    else
        for (int decade = -6; decade <= 3; ++decade)
            add(std::pow(10.0, decade), std::numeric_limits<double>::max());
    return values;
}

// Lines at powers of ten, or between them where there would be less than two.
void drawGrid(const Ui& ui, const Axes& axes) {
    constexpr std::array kCoarse = {1.0};
    constexpr std::array kMiddle = {1.0, 2.0, 5.0};
    constexpr std::array kFine = {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0};
    const TextStyle style{ui.theme.fonts.small, color::kSecondary};
    std::vector<double> values = gridValues(axes, kCoarse);
    if (values.size() < 2)
        values = gridValues(axes, kMiddle);
    if (values.size() < 2)
        values = gridValues(axes, kFine);
    float last_y = std::numeric_limits<float>::max();
    for (const double value : values)
        gridLine(ui, axes, value, last_y);
    const float below = axes.plot.end().y + ui.px(4);
    drawText(ui, {axes.plot.position.x, below}, Align::Left, "0", style);
    drawText(ui, {axes.plot.end().x, below}, Align::Right, "triangles 100 %", style);
}

// The original's size; its error is none: the lower edge.
void drawOriginal(const Ui& ui, const Axes& axes, const Document& document) {
    const bool size = axes.kind == ChartKind::Size;
    const double value = size ? originalBytes(document) : 0.0;
    if (size && value <= 0.0)
        return;
    const float y = std::round(axes.y(value)) + 0.5f;
    const float dash = ui.px(4);
    for (float x = axes.plot.position.x; x < axes.plot.end().x; x += 2 * dash)
        ImGui::GetWindowDrawList()->AddLine(
            {x, y}, {std::min(x + dash, axes.plot.end().x), y}, color::kText, ui.theme.hairline());
}

void drawCurve(const Ui& ui, const Axes& axes, const Lane& lane, const SizeCurve& curve) {
    std::vector<ImVec2> points;
    for (const SizePoint& point : curve)
        points.emplace_back(axes.x(point.ratio), axes.y(axes.valueOf(point)));
    const ImU32 colour = packed(lane.settings.colour);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddPolyline(points.data(), static_cast<int>(points.size()), colour, 0, ui.px(1.6f));
    if (lane.status.lod) {
        const LaneNumbers& numbers = lane.status.numbers;
        list.AddCircleFilled(
            {axes.x(numbers.ratio), axes.y(axes.valueOf(numbers))}, ui.px(3.5f), colour, 20);
        if (axes.kind == ChartKind::Error && lane.status.distance && lane.settings.algorithm)
            list.AddCircle({axes.x(numbers.ratio), axes.y(lane.status.distance->hausdorff)},
                           ui.px(4.5f),
                           colour,
                           20,
                           ui.px(1.5f));
    }
}

// Value of a curve at a ratio, between its points; negative outside.
double valueAt(const Axes& axes, const SizeCurve& curve, double ratio) {
    for (std::size_t at = 1; at < curve.size(); ++at) {
        const SizePoint& a = curve[at - 1];
        const SizePoint& b = curve[at];
        if (ratio < a.ratio || ratio > b.ratio)
            continue;
        return axes.valueOf(a) +
               (axes.valueOf(b) - axes.valueOf(a)) * (ratio - a.ratio) / (b.ratio - a.ratio);
    }
    return -1.0;
}

// Under the mouse: a line and what each lane would have there.
void drawReading(const Ui& ui,
                 const PanelInput& input,
                 const WindowState& state,
                 const Axes& axes) {
    const float x = ImGui::GetIO().MousePos.x;
    const double ratio = static_cast<double>((x - axes.plot.position.x) / axes.plot.size.x);
    if (ratio < 0.0 || ratio > 1.0)
        return;
    verticalHairline(ui, x, axes.plot.position.y, axes.plot.end().y);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(10), ui.px(8)});
    ImGui::BeginTooltip();
    ImGui::TextDisabled("%s of the triangles", formatRatio(ratio).c_str());
    int lanes = 0;
    for (const Lane& lane : input.document.lanes) {
        const double value = valueAt(axes, state.curves.of(lane.id), ratio);
        if (value < 0.0)
            continue;
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddCircleFilled(
            at + ImVec2(ui.px(4), ui.px(8)), ui.px(4), packed(lane.settings.colour), 20);
        const std::string name(laneName(lane.settings));
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ui.px(16));
        ImGui::Text("%s  %s", name.c_str(), axes.text(value).c_str());
        ++lanes;
    }
    ui.log.object("reading",
                  axes.kind == ChartKind::Size ? "chart" : "error chart",
                  "\"ratio\":" + std::to_string(ratio) + ",\"lanes\":" + std::to_string(lanes));
    ImGui::EndTooltip();
    ImGui::PopStyleVar();
}

} // namespace

void drawLaneChart(const Ui& ui,
                   const PanelInput& input,
                   const WindowState& state,
                   ChartKind kind,
                   const Area& area) {
    const float labels = ui.px(56);
    const bool size = kind == ChartKind::Size;
    Axes axes;
    axes.kind = kind;
    axes.plot = {{area.position.x + labels, area.position.y + ui.px(18)},
                 {std::max(1.0f, area.size.x - labels), std::max(1.0f, area.size.y - ui.px(36))}};
    drawText(ui,
             {axes.plot.position.x, area.position.y},
             Align::Left,
             size ? "projected size, log" : "estimated error, log",
             {ui.theme.fonts.small, color::kSecondary});
    if (!fitAxes(input, state, axes)) {
        const bool known = std::ranges::any_of(input.document.lanes, [&](const Lane& lane) {
            return !state.curves.of(lane.id).empty();
        });
        if (known)
            drawText(ui,
                     axes.plot.position + ImVec2(0, axes.plot.size.y * 0.5f - ui.px(8)),
                     Align::Left,
                     "none: every level keeps the surface",
                     {nullptr, color::kSecondary});
        return;
    }
    drawGrid(ui, axes);
    drawOriginal(ui, axes, input.document);
    for (const Lane& lane : input.document.lanes)
        drawCurve(ui, axes, lane, state.curves.of(lane.id));
    ImGui::SetCursorScreenPos(axes.plot.position);
    ImGui::InvisibleButton(size ? "chart" : "error chart", axes.plot.size);
    ui.record(size ? "chart" : "error chart");
    if (ImGui::IsItemHovered())
        drawReading(ui, input, state, axes);
}

} // namespace lodestone::ui
