#include "ui/lane_view.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr float kBarHeight = 27.0f;
constexpr float kGrabWidth = 14.0f; // of the divider, for the mouse

struct Pair {
    const Lane* left = nullptr;
    const Lane* right = nullptr;
};

// The active lane right, the original left; where that is the active one, the lane after it.
Pair splitLanes(const Document& document) {
    const Lane* const active = document.findLane(document.active_lane);
    const Lane* other = nullptr;
    for (const Lane& lane : document.lanes)
        if (&lane != active && (!other || !lane.settings.algorithm))
            other = &lane;
    return active && !active->settings.algorithm ? Pair{active, other} : Pair{other, active};
}

// The part of the lane's picture between two shares of the width.
void drawPart(const PanelInput& input, const Lane& lane, const Area& area, float begin, float end) {
    const LanePicture* const picture = input.pictureOf(lane.id);
    if (picture && picture->texture)
        ImGui::GetWindowDrawList()->AddImage(
            picture->texture,
            {area.position.x + area.size.x * begin, area.position.y},
            {area.position.x + area.size.x * end, area.end().y},
            {begin, 1},
            {end, 0});
}

// Returns the divider's new place.
float drawDivider(const Ui& ui, const Area& area, float place) {
    const float x = std::round(area.position.x + area.size.x * place);
    const float grab = ui.px(kGrabWidth);
    ImGui::SetCursorScreenPos({x - grab * 0.5f, area.position.y});
    ImGui::InvisibleButton("divider", {grab, area.size.y});
    ui.record("divider");
    const bool held = ImGui::IsItemActive();
    if (held || ImGui::IsItemHovered())
        ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddLine({x, area.position.y}, {x, area.end().y}, color::kText, ui.theme.hairline());
    const ImVec2 middle{x, area.position.y + area.size.y * 0.5f};
    list.AddCircleFilled(middle, ui.px(7), held ? color::kAccent : color::kText, 24);
    if (held)
        place = (ImGui::GetIO().MousePos.x - area.position.x) / area.size.x;
    return std::clamp(place, 0.0f, 1.0f);
}

} // namespace

void drawSplitView(const Ui& ui, const PanelInput& input, WindowState& state, const Area& area) {
    const Pair pair = splitLanes(input.document);
    if (!pair.left || !pair.right)
        return;
    Ui named = ui;
    named.panel = "Split";
    const float bar = std::round(ui.px(kBarHeight));
    const Area picture{{area.position.x, area.position.y + bar},
                       {area.size.x, std::max(1.0f, area.size.y - 2 * bar)}};
    // Kept by the window that the views are in; it lives as long as the program.
    float& divider = *ImGui::GetStateStorage()->GetFloatRef(ImGui::GetID("split"), 0.5f);
    drawPart(input, *pair.left, picture, 0.0f, divider);
    drawPart(input, *pair.right, picture, divider, 1.0f);
    pictureButton(named, picture);
    const float mouse_x =
        (state.box_lane == kNoLane ? ImGui::GetIO().MousePos
                                   : ImGui::GetIO().MouseClickedPos[ImGuiMouseButton_Left])
            .x;
    const float seen_at = (mouse_x - picture.position.x) / picture.size.x;
    pictureGestures(named, input, state, (seen_at < divider ? pair.left : pair.right)->id, picture);
    divider = drawDivider(named, picture, divider);
    const float half = std::round(area.size.x * 0.5f);
    for (const Lane* const lane : {pair.left, pair.right}) {
        const bool is_left = lane == pair.left;
        const float x = area.position.x + (is_left ? 0.0f : half);
        const float width = is_left ? half - ui.theme.hairline() : area.size.x - half;
        const LanePicture* const shown = input.pictureOf(lane->id);
        named.panel = "View " + std::to_string(lane->id);
        ImGui::PushID(static_cast<int>(lane->id));
        drawLaneState(named,
                      state,
                      *lane,
                      shown && shown->draft,
                      {{x, picture.position.y}, {width, picture.size.y}});
        drawLaneHeader(named, input, state, *lane, {{x, area.position.y}, {width, bar}});
        drawLaneFooter(named, input.document, *lane, {{x, picture.end().y}, {width, bar}});
        ImGui::PopID();
        requestPicture(input, state, lane->id, picture);
    }
}

void drawFlickerView(const Ui& ui, const PanelInput& input, WindowState& state, const Area& area) {
    constexpr double kTurnSeconds = 0.5;
    const Pair pair = splitLanes(input.document);
    if (!pair.left || !pair.right)
        return;
    const double turns = ImGui::GetTime() / kTurnSeconds;
    const Lane& lane = std::fmod(turns, 2.0) < 1.0 ? *pair.left : *pair.right;
    state.wakeIn((std::floor(turns) + 1.0 - turns) * kTurnSeconds + 0.002);
    const float bar = std::round(ui.px(kBarHeight));
    const Area picture{{area.position.x, area.position.y + bar},
                       {area.size.x, std::max(1.0f, area.size.y - 2 * bar)}};
    Ui named = ui;
    named.panel = "Flicker";
    drawPart(input, lane, picture, 0.0f, 1.0f);
    pictureButton(named, picture);
    ui.log.object("flicker", "flicker", "\"lane\":" + std::to_string(lane.id));
    pictureGestures(named, input, state, lane.id, picture);
    const LanePicture* const shown = input.pictureOf(lane.id);
    drawLaneState(named, state, lane, shown && shown->draft, picture);
    named.panel = "View " + std::to_string(lane.id);
    ImGui::PushID(static_cast<int>(lane.id));
    drawLaneHeader(named, input, state, lane, {area.position, {area.size.x, bar}});
    drawLaneFooter(
        named, input.document, lane, {{area.position.x, picture.end().y}, {area.size.x, bar}});
    ImGui::PopID();
    requestPicture(input, state, pair.left->id, picture);
    requestPicture(input, state, pair.right->id, picture);
}

} // namespace lodestone::ui
