#include "ui/lane_reorder.h"
#include "ui/lane_view.h"
#include "ui/legend.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lodestone::ui {

namespace {

constexpr float kBarHeight = 27.0f;        // header and footer of a view
constexpr float kCompactBarHeight = 21.0f; // where cells are low
constexpr float kLowCell = 190.0f;         // height
constexpr double kPreferredAspect = 1.3;   // of a picture

struct Cells {
    int columns = 1;
    int rows = 1;
};

// Four, six and nine views stand as people compare them; else columns and rows that leave the
// largest picture of the preferred aspect.
Cells arrange(int count, double width, double height, double bars_height) {
    const bool wide = width > height;
    if (count == 4)
        return {2, 2};
    if (count == 6)
        return wide ? Cells{3, 2} : Cells{2, 3};
    if (count == 9)
        return {3, 3};
    Cells best;
    double best_area = -1.0;
    for (int columns = 1; columns <= count; ++columns) {
        const int rows = (count + columns - 1) / columns;
        const double cell_width = width / columns;
        const double picture_height = height / rows - bars_height;
        const double fitted = std::min(cell_width, picture_height * kPreferredAspect);
        const double area = fitted * fitted;
        if (area > best_area) {
            best_area = area;
            best = {columns, rows};
        }
    }
    return best;
}

// A cell without the hairlines that part it from those right of it and below it, which it draws.
Area beginCell(const Ui& ui, const Area& grid, const Cells& cells, int at) {
    const float line = ui.theme.hairline();
    const int column = at % cells.columns;
    const int row = at / cells.columns;
    const auto corner = [&](int columns, int rows) {
        return ImVec2{std::round(grid.position.x + grid.size.x * static_cast<float>(columns) /
                                                       static_cast<float>(cells.columns)),
                      std::round(grid.position.y + grid.size.y * static_cast<float>(rows) /
                                                       static_cast<float>(cells.rows))};
    };
    const ImVec2 begin = corner(column, row);
    ImVec2 end = corner(column + 1, row + 1);
    if (column + 1 < cells.columns) {
        end.x -= line;
        verticalHairline(ui, end.x, begin.y, end.y);
    }
    if (row + 1 < cells.rows) {
        end.y -= line;
        horizontalHairline(ui, begin.x, end.x, end.y);
    }
    return {begin, end - begin};
}

// The lanes in view: the first few, moved along so that the active lane is among them.
std::vector<const Lane*> shownLanes(const Document& document, int cell_count) {
    std::vector<const Lane*> lanes;
    for (const Lane& lane : document.lanes)
        lanes.push_back(&lane);
    const auto wanted = static_cast<std::size_t>(cell_count);
    if (cell_count == 0 || wanted >= lanes.size())
        return lanes;
    std::size_t first = 0;
    for (std::size_t at = wanted; at < lanes.size(); ++at)
        if (lanes[at]->id == document.active_lane)
            first = at + 1 - wanted;
    return {lanes.begin() + static_cast<std::ptrdiff_t>(first),
            lanes.begin() + static_cast<std::ptrdiff_t>(first + wanted)};
}

void drawPicture(
    const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane, const Area& area) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(area.position, area.end(), color::kView);
    const LanePicture* const picture = input.pictureOf(lane.id);
    const bool drawn = picture && picture->texture;
    if (drawn)
        list.AddImage(picture->texture, area.position, area.end(), {0, 1}, {1, 0});
    pictureButton(ui, area);
    if (ImGui::IsItemActivated())
        ui.push(SetActiveLane{lane.id});
    pictureGestures(ui, input, state, lane.id, area);
    drawLegend(ui, input.document, lane, area);
    drawLaneState(ui, state, lane, drawn && picture->draft, area);
    requestPicture(input, state, lane.id, area);
}

void drawCell(
    const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane, const Area& area) {
    ImGui::PushID(static_cast<int>(lane.id));
    Ui named = ui;
    named.panel = "View " + std::to_string(lane.id);
    const bool low = area.size.y < ui.px(kLowCell);
    const float header = std::round(ui.px(low ? kCompactBarHeight : kBarHeight));
    const float footer = header;
    const float picture_height = std::max(1.0f, area.size.y - header - footer);
    drawPicture(named,
                input,
                state,
                lane,
                {{area.position.x, area.position.y + header}, {area.size.x, picture_height}});
    drawLaneHeader(named, input, state, lane, {area.position, {area.size.x, header}});
    laneHandle(named,
               input.document,
               state,
               lane,
               {area.position, {area.size.x - ui.px(kLaneMenuWidth), header}});
    drawLaneFooter(named,
                   input.document,
                   lane,
                   {{area.position.x, area.end().y - footer}, {area.size.x, footer}});
    if (lane.id == input.document.active_lane && input.document.lanes.size() > 1)
        ImGui::GetWindowDrawList()->AddRect(
            area.position, area.end(), color::kAccent, 0, 0, std::max(1.0f, ui.px(1.5f)));
    ImGui::PopID();
}

// A cell without a lane: what could be there, in as many columns as its height asks for, each as
// wide as its names.
void drawFreeCell(const Ui& ui, const Area& area) {
    const float line = ui.px(21);
    const float margin = ui.px(12);
    const float gap = ui.px(20);
    const float dot = ui.px(16);
    const std::span<const Algorithm> all = algorithms();
    const float height = area.size.y - 2 * margin;
    const auto rows = static_cast<std::size_t>(std::max(1.0f, height / line - 1.0f));
    const std::size_t columns = (all.size() + rows - 1) / rows;
    const std::size_t in_column = (all.size() + columns - 1) / columns;
    const auto name_of = [&](const Algorithm& algorithm) {
        return columns == 1 ? algorithm.name : algorithm.short_name;
    };
    std::vector<float> widths(columns, 0.0f);
    for (std::size_t at = 0; at < all.size(); ++at)
        widths[at / in_column] =
            std::max(widths[at / in_column], dot + textWidth(ui, name_of(all[at])));
    const float block =
        std::accumulate(widths.begin(), widths.end(), gap * static_cast<float>(columns - 1));
    float left = area.position.x + std::max(margin, (area.size.x - block) * 0.5f);
    const float top =
        area.position.y +
        std::max(margin, (area.size.y - line * static_cast<float>(in_column + 1)) * 0.5f);
    drawText(ui, {left, top}, Align::Left, "Add a lane", {nullptr, color::kSecondary});
    for (std::size_t at = 0; at < all.size(); ++at) {
        const std::size_t row = at % in_column + 1;
        if (at > 0 && row == 1)
            left += widths[at / in_column - 1] + gap;
        const ImVec2 place{left, top + line * static_cast<float>(row)};
        ImGui::GetWindowDrawList()->AddCircleFilled(
            place + ImVec2(ui.px(4), ui.px(8)), ui.px(4), packed(laneColour(&all[at], 0)), 24);
        ImGui::SetCursorScreenPos(place + ImVec2(dot, 0));
        const float room = area.end().x - ui.px(4) - left - dot;
        if (linkButton(ui, fitText(ui, name_of(all[at]), room)))
            ui.push(AddLane{std::string(all[at].id)});
        tooltip(ui, all[at].summary);
    }
}

} // namespace

void drawLaneGrid(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Grid";
    state.views.clear();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color::kView);
    beginPanel("Grid", area.position, area.size, PanelScroll::None);
    const CompareMode compare = input.document.view.compare;
    const bool one_place = compare == CompareMode::Split || compare == CompareMode::Flicker;
    if (one_place && input.document.lanes.size() > 1) {
        if (compare == CompareMode::Split)
            drawSplitView(ui, input, state, area);
        else
            drawFlickerView(ui, input, state, area);
        endPanel();
        ImGui::PopStyleColor();
        ImGui::PopStyleVar();
        return;
    }
    const std::vector<const Lane*> lanes = shownLanes(input.document, state.cell_count);
    const int count = std::max({1, state.cell_count, static_cast<int>(lanes.size())});
    const auto bars = static_cast<double>(ui.px(2 * kBarHeight));
    const Cells cells =
        arrange(count, static_cast<double>(area.size.x), static_cast<double>(area.size.y), bars);
    std::vector<LaneCell> shown;
    for (int at = 0; at < count && input.document.scene; ++at) {
        const bool free = static_cast<std::size_t>(at) >= lanes.size();
        const Lane* const lane = free ? nullptr : lanes[static_cast<std::size_t>(at)];
        shown.push_back({lane ? lane->id : kNoLane, beginCell(ui, area, cells, at)});
        if (lane)
            drawCell(ui, input, state, *lane, shown.back().area);
        else
            drawFreeCell(ui, shown.back().area);
    }
    dragLane(ui, input.document, state, shown);
    endPanel();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
