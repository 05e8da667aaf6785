#include "ui/lane_reorder.h"

#include "ui/lane_text.h"
#include "ui/legend.h"
#include "ui/widgets.h"

#include <algorithm>

namespace lodestone::ui {

namespace {

bool contains(const Area& area, const ImVec2& point) {
    return point.x >= area.position.x && point.y >= area.position.y && point.x < area.end().x &&
           point.y < area.end().y;
}

std::size_t placeOf(const Document& document, LaneId lane) {
    const auto found = std::ranges::find(document.lanes, lane, &Lane::id);
    return static_cast<std::size_t>(found - document.lanes.begin());
}

// The lane would stand there: a bar at the side that the others move away to.
void drawGoal(const Ui& ui, const LaneCell& cell, bool moves_on) {
    const float width = ui.px(3);
    const float x = moves_on ? cell.area.end().x - width : cell.area.position.x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(cell.area.position,
                       cell.area.end(),
                       (color::kAccent & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 0x20));
    list.AddRectFilled({x, cell.area.position.y}, {x + width, cell.area.end().y}, color::kAccent);
}

} // namespace

void laneHandle(const Ui& ui,
                const Document& document,
                WindowState& state,
                const Lane& lane,
                const Area& area) {
    ImGui::SetCursorScreenPos(area.position);
    ImGui::InvisibleButton("handle", {std::max(1.0f, area.size.x), std::max(1.0f, area.size.y)});
    ui.record("handle");
    if (ImGui::IsItemActivated()) {
        ui.push(SetActiveLane{lane.id});
        state.moved_lane = lane.id;
    }
    if (state.moved_lane != kNoLane)
        return;
    std::string words(laneName(lane.settings));
    if (const std::string summary = laneSummary(document, lane); !summary.empty())
        words += " \u00b7 " + summary;
    if (document.lanes.size() > 1)
        words += "\nDrag it to another view to move the lane.";
    tooltip(ui, words);
}

void dragLane(const Ui& ui,
              const Document& document,
              WindowState& state,
              std::span<const LaneCell> cells) {
    const Lane* const lane = document.findLane(state.moved_lane);
    const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (!held || ui.widgets.drag_cancelled || !lane)
        state.moved_lane = kNoLane;
    if (!lane || ui.widgets.drag_cancelled)
        return;
    const ImGuiIO& io = ImGui::GetIO();
    const auto goal = std::ranges::find_if(
        cells, [&](const LaneCell& cell) { return contains(cell.area, io.MousePos); });
    if (goal == cells.end() || goal->lane == lane->id)
        return;
    const std::size_t from = placeOf(document, lane->id);
    const std::size_t to = std::min(placeOf(document, goal->lane), document.lanes.size() - 1);
    if (from == to)
        return;
    if (!held) {
        ui.push(MoveLane{lane->id, static_cast<std::uint32_t>(to)});
        return;
    }
    drawGoal(ui, *goal, to > from);
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeAll);
    drawOnPlate(ui,
                io.MousePos + ImVec2(ui.px(14), ui.px(10)),
                Align::Left,
                laneName(lane->settings),
                {ui.theme.fonts.semibold, packed(lane->settings.colour)});
}

} // namespace lodestone::ui
