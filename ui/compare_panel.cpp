#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/target_slider.h"
#include "ui/widgets.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr float kTitleHeight = 26.0f;
constexpr float kRowHeight = 29.0f;
constexpr float kLowestRow = 22.5f;           // where there are many
constexpr float kWidthOfBothCharts = 1700.0f; // of the panel

struct Column {
    std::string_view title;
    double right; // of the table's width, 0..1
    std::string_view tooltip;
};

// The lane's name and slider stand left of these.
constexpr std::array<Column, 8> kColumns = {{
    {"Triangles", 0.395, "Triangles, every instance counted."},
    {"Ratio", 0.480, "Share of the original's triangles, in %."},
    {"Projected size", 0.625, "Size of the exported file with the present export options."},
    {"FPS", 0.690, "Frames a second that this lane alone would reach in its view."},
    {"ms", 0.750, "Milliseconds that a frame of this lane takes; measured or of the last draw."},
    {"Hausdorff %", 0.845, "Largest distance to the original, in % of the scene's diagonal."},
    {"Mean %", 0.915, "Mean distance to the original, in % of the scene's diagonal."},
    {"Built in", 0.990, "Seconds that building took: once, then any LOD is read out at once."},
}};
constexpr double kSliderBegin = 0.150;
constexpr double kSliderEnd = 0.275;

std::array<std::string, kColumns.size()> cellsOf(const Lane& lane) {
    const LaneStatus& status = lane.status;
    std::array<std::string, kColumns.size()> cells;
    cells.fill(kUnknown);
    if (status.lod) {
        cells[0] = formatCount(status.numbers.triangles);
        cells[1] = formatRatio(status.numbers.ratio);
        cells[2] = formatBytes(status.numbers.predicted_bytes);
    }
    if (status.rate_wanted) {
        cells[3] = cells[4] = "\u2026";
    } else if (const double time_ms = frameMilliseconds(lane); time_ms > 0.0) {
        cells[3] = formatRate(framesPerSecond(lane));
        char time[16] = "";
        std::snprintf(time, sizeof time, "%.1f", time_ms);
        cells[4] = time;
    }
    if (status.measuring)
        cells[5] = cells[6] = "\u2026";
    else if (status.distance && lane.settings.algorithm) {
        cells[5] = formatError(status.distance->hausdorff);
        cells[6] = formatError(status.distance->mean);
    }
    if (status.build_seconds > 0.0)
        cells[7] = formatSeconds(status.build_seconds);
    return cells;
}

void drawTitles(const Ui& ui, const ImVec2& begin, float width) {
    const float y = begin.y + ui.px(8);
    const TextStyle style{ui.theme.fonts.small, color::kSecondary};
    drawText(ui, {begin.x + ui.px(8), y}, Align::Left, "Lane", style);
    ImGui::SetCursorScreenPos({begin.x + ui.px(52), begin.y + ui.px(6)});
    if (linkButton(ui, "Measure", color::kAccent)) {
        ui.push(MeasureLane{kNoLane});
        ui.push(MeasureRates{});
    }
    tooltip(ui,
            "Distances to the original from 300 000 points, and the frame rate by the papers' "
            "protocol: drawn off screen again and again, frames 100 to 1 100 (up to 4 s a lane).");
    drawText(
        ui, {begin.x + width * static_cast<float>(kSliderBegin), y}, Align::Left, "Target", style);
    for (const Column& column : kColumns) {
        const float right = begin.x + width * static_cast<float>(column.right);
        const float title = textWidth(ui, column.title, style.font);
        drawText(ui, {right, y}, Align::Right, column.title, style);
        ImGui::SetCursorScreenPos({right - title, begin.y});
        ImGui::InvisibleButton(column.title.data(), {title, ui.px(kTitleHeight)});
        tooltip(ui, column.tooltip);
    }
    horizontalHairline(ui, begin.x, begin.x + width, begin.y + ui.px(kTitleHeight));
}

void drawCells(
    const Ui& ui, const PanelInput& input, const Lane& lane, const ImVec2& begin, float width) {
    const auto cells = cellsOf(lane);
    const bool estimated =
        isEstimated(input.document.export_options) || lane.status.numbers.bytes_estimated;
    const char* const certainty = estimated ? "about" : "exact";
    const float y = begin.y;
    for (std::size_t at = 0; at < cells.size(); ++at) {
        float right = begin.x + width * static_cast<float>(kColumns[at].right);
        if (at == 2 && lane.status.lod) {
            drawText(ui,
                     {right, y + ui.px(2)},
                     Align::Right,
                     certainty,
                     {ui.theme.fonts.small, color::kSecondary});
            right -= textWidth(ui, certainty, ui.theme.fonts.small) + ui.px(4);
        }
        const ImU32 ink = cells[at] == kUnknown ? color::kSecondary : color::kText;
        drawText(ui, {right, y}, Align::Right, cells[at], {nullptr, ink});
    }
}

void drawRow(const Ui& ui,
             const PanelInput& input,
             const WindowState& state,
             const Lane& lane,
             const ImVec2& size) {
    const ImVec2 begin = ImGui::GetCursorScreenPos();
    const float width = size.x;
    const float height = size.y;
    const ImVec2 end = begin + size;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::PushID(static_cast<int>(lane.id));
    if (lane.id == input.document.active_lane)
        list.AddRectFilled(begin, end, color::kSelection);
    const float y = begin.y + (height - ImGui::GetTextLineHeight()) * 0.5f;
    const float slider_x = begin.x + width * static_cast<float>(kSliderBegin);
    if (ImGui::InvisibleButton("row", {slider_x - begin.x - ui.px(4), height}))
        ui.push(SetActiveLane{lane.id});
    ui.record("row");
    list.AddCircleFilled(
        {begin.x + ui.px(12), begin.y + height * 0.5f}, ui.px(4), packed(lane.settings.colour), 24);
    const float name_x = begin.x + ui.px(24);
    drawText(ui,
             {name_x, y},
             Align::Left,
             fitText(ui, laneName(lane.settings), slider_x - name_x - ui.px(6)));
    if (lane.settings.algorithm) {
        ImGui::SetCursorScreenPos({slider_x, begin.y + (height - ui.px(16)) * 0.5f});
        laneTargetSlider(
            ui, input, state, lane, width * static_cast<float>(kSliderEnd - kSliderBegin));
    }
    drawCells(ui, input, lane, {begin.x, y}, width);
    horizontalHairline(ui, begin.x, end.x, end.y - ui.theme.hairline());
    ImGui::PopID();
    ImGui::SetCursorScreenPos({begin.x, end.y});
}

// Rows become lower before the table scrolls, and then as many as are seen are seen whole.
float rowHeight(const Ui& ui, float room, std::size_t lane_count) {
    const float most = std::floor(room / ui.px(kLowestRow));
    const float shown = std::max(1.0f, std::min(static_cast<float>(lane_count), most));
    return std::min(ui.px(kRowHeight), std::floor(room / shown));
}

void drawTable(const Ui& ui, const PanelInput& input, const WindowState& state, const Area& area) {
    const float top = area.position.y + ui.px(kTitleHeight) + ui.theme.hairline();
    const float room = area.end().y - top;
    const std::size_t lane_count = input.document.lanes.size();
    const float height = rowHeight(ui, room, lane_count);
    const bool scrolls = height * static_cast<float>(lane_count) > room;
    const float width = area.size.x - (scrolls ? ImGui::GetStyle().ScrollbarSize : 0.0f);
    drawTitles(ui, area.position, width);
    ImGui::SetCursorScreenPos({area.position.x, top});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {0, 0});
    ImGui::BeginChild("rows", {area.size.x, scrolls ? std::floor(room / height) * height : room});
    Ui named = ui;
    for (const Lane& lane : input.document.lanes) {
        named.panel = "Lane " + std::to_string(lane.id);
        drawRow(named, input, state, lane, {width, height});
    }
    ImGui::EndChild();
    ImGui::PopStyleVar();
}

} // namespace

namespace {

// Size and error over triangles: both where there is room, else one of them by choice.
void drawCharts(const Ui& ui, const PanelInput& input, WindowState& state, const Area& area) {
    constexpr std::array<std::string_view, 2> kKinds = {"size", "error"};
    constexpr std::array<std::string_view, 2> kTips = {
        "The exported size of every lane over its triangles.",
        "The estimated error of every lane over its triangles; rings are measured maxima."};
    if (ImGui::GetIO().DisplaySize.x >= ui.px(kWidthOfBothCharts)) {
        const float gap = ui.px(16);
        const ImVec2 half{(area.size.x - gap) * 0.5f, area.size.y};
        drawLaneChart(ui, input, state, ChartKind::Size, {area.position, half});
        drawLaneChart(ui,
                      input,
                      state,
                      ChartKind::Error,
                      {{area.position.x + half.x + gap, area.position.y}, half});
        return;
    }
    const bool error = state.chart == ChartKind::Error;
    ImGui::SetCursorScreenPos(
        {area.end().x - segmentedWidth(ui, kKinds), area.position.y - ui.px(4)});
    if (segmented(ui, {"Chart", kKinds, error ? 1 : 0, kTips}))
        state.chart = error ? ChartKind::Size : ChartKind::Error;
    drawLaneChart(ui, input, state, state.chart, area);
}

} // namespace

void drawComparePanel(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Compare";
    if (area.size.y <= 0)
        return;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    beginPanel("Compare", area.position, area.size, PanelScroll::None);
    const bool both = area.size.x >= ui.px(kWidthOfBothCharts);
    const float chart_width =
        std::round(std::max(ui.px(270), area.size.x * (both ? 0.40f : 0.24f)));
    const float margin = ui.px(12);
    const Area table{{area.position.x + margin, area.position.y},
                     {area.size.x - chart_width - 3 * margin, area.size.y - ui.px(4)}};
    if (input.document.scene) {
        drawTable(ui, input, state, table);
        drawCharts(ui,
                   input,
                   state,
                   {{table.end().x + margin, area.position.y + ui.px(8)},
                    {chart_width, area.size.y - ui.px(14)}});
    }
    horizontalHairline(ui, area.position.x, area.end().x, area.position.y);
    endPanel();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
