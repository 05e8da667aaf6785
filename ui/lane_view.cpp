#include "ui/lane_view.h"

#include "ui/camera_gestures.h"
#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/legend.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

void laneMenu(const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane) {
    const auto& lanes = input.document.lanes;
    const auto place = std::find_if(
        lanes.begin(), lanes.end(), [&](const Lane& other) { return other.id == lane.id; });
    const auto index = static_cast<std::uint32_t>(place - lanes.begin());
    if (ImGui::BeginMenu("Algorithm")) {
        if (menuItem(ui, "Original", nullptr, !lane.settings.algorithm))
            ui.push(SetLaneAlgorithm{lane.id, {}});
        for (const Algorithm& algorithm : algorithms())
            if (menuItem(ui, algorithm.name, nullptr, lane.settings.algorithm == &algorithm))
                ui.push(SetLaneAlgorithm{lane.id, std::string(algorithm.id)});
        ImGui::EndMenu();
    }
    if (menuItem(ui, "Duplicate", nullptr))
        ui.push(DuplicateLane{lane.id});
    if (menuItem(ui, "Move left", nullptr, false, index > 0))
        ui.push(MoveLane{lane.id, index - 1});
    if (menuItem(ui, "Move right", nullptr, false, index + 1 < lanes.size()))
        ui.push(MoveLane{lane.id, index + 1});
    ImGui::Separator();
    if (menuItem(ui, "Measure distance", nullptr, false, lane.status.lod != nullptr))
        ui.push(MeasureLane{lane.id});
    if (menuItem(ui, "Export LOD\u2026", "Ctrl+E", false, lane.status.lod != nullptr)) {
        ui.push(SetActiveLane{lane.id});
        openExportDialog(input, state);
    }
    ImGui::Separator();
    if (menuItem(ui, "Remove", nullptr, false, lanes.size() > 1))
        ui.push(RemoveLane{lane.id});
}

} // namespace

namespace {

// At the right: the measured distances to the original, as much as has room. Returns where they
// begin.
float drawDistance(const Ui& ui, const Lane& lane, const Area& area) {
    const float end = area.end().x - ui.px(6);
    if (!lane.status.distance || !lane.settings.algorithm)
        return end;
    const std::string hausdorff = formatError(lane.status.distance->hausdorff);
    const std::string mean = formatError(lane.status.distance->mean);
    const std::string both = hausdorff + " / " + mean + " %";
    std::string named = "Hausdorff ";
    named.append(hausdorff).append(" %, mean ").append(mean).append(" %");
    ImFont* const small = ui.theme.fonts.small;
    for (const std::string& words : {named, both}) {
        const float width = textWidth(ui, words, small);
        if (width > area.size.x * 0.7f)
            continue;
        drawText(ui,
                 {end - width, area.position.y + ui.px(2)},
                 Align::Left,
                 words,
                 {small, color::kText});
        return end - width - ui.px(8);
    }
    return end;
}

} // namespace

void drawLaneHeader(
    const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane, const Area& area) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(area.position, area.end(), color::kPanel);
    const float middle = area.position.y + area.size.y * 0.5f;
    const float text_y = middle - ImGui::GetTextLineHeight() * 0.5f;
    float x = area.position.x + ui.px(10);
    list.AddCircleFilled({x + ui.px(4), middle}, ui.px(4), packed(lane.settings.colour), 24);
    x += ui.px(16);
    const std::string_view name = laneName(lane.settings);
    drawText(ui, {x, text_y}, Align::Left, name, {ui.theme.fonts.semibold});
    x += textWidth(ui, name, ui.theme.fonts.semibold) + ui.px(8);
    const float menu_margin = ui.px(4);
    const float menu_width = ui.px(kLaneMenuWidth) - menu_margin;
    const float menu_x = area.end().x - menu_width - menu_margin;
    const float summary_end = drawDistance(ui, lane, {{x, text_y}, {menu_x - x, 0}});
    drawText(ui,
             {x, text_y},
             Align::Left,
             fitText(ui, laneSummary(input.document, lane), std::max(0.0f, summary_end - x)),
             {nullptr, color::kSecondary});
    ImGui::SetCursorScreenPos({menu_x, area.position.y + ui.px(2)});
    if (ImGui::InvisibleButton("menu", {menu_width, area.size.y - ui.px(4)}))
        ImGui::OpenPopup("lane menu");
    ui.record("menu");
    const ImU32 ink = ImGui::IsItemHovered() ? color::kText : color::kSecondary;
    for (int dot = -1; dot <= 1; ++dot)
        list.AddCircleFilled(
            {menu_x + menu_width * 0.5f + ui.px(4) * static_cast<float>(dot), middle},
            ui.px(1.3f),
            ink,
            12);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(10), ui.px(8)}); // not the grid's
    if (ImGui::BeginPopup("lane menu")) {
        laneMenu(ui, input, state, lane);
        closeOnEscape();
        ImGui::EndPopup();
    }
    ImGui::PopStyleVar();
}

namespace {

struct FooterWords {
    std::string triangles;
    std::string ratio;
    std::string size;
    std::string time;
    std::string rate;
};

FooterWords footerWords(const Document& document, const Lane& lane) {
    const LaneNumbers& numbers = lane.status.numbers;
    FooterWords words;
    if (!lane.status.lod)
        return words;
    words.triangles = formatCount(numbers.triangles);
    words.ratio = formatRatio(numbers.ratio);
    const bool estimated = isEstimated(document.export_options) || numbers.bytes_estimated;
    words.size = (estimated ? "~" : "") + formatBytes(numbers.predicted_bytes);
    if (const double time_ms = frameMilliseconds(lane); time_ms > 0.0) {
        words.time = formatMilliseconds(time_ms);
        words.rate = formatRate(framesPerSecond(lane));
    }
    return words;
}

} // namespace

// Left: triangles and ratio; middle: size; right: time and rate. What does not fit is left out.
void drawLaneFooter(const Ui& ui, const Document& document, const Lane& lane, const Area& area) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(area.position, area.end(), color::kPanel);
    const float y = area.position.y + (area.size.y - ImGui::GetTextLineHeight()) * 0.5f;
    const float inner = area.size.x - ui.px(20);
    FooterWords words = footerWords(document, lane);
    if (words.triangles.empty())
        return;
    ImFont* const bold = ui.theme.fonts.semibold;
    const float gap = ui.px(8);
    const auto left_width = [&] {
        return textWidth(ui, words.triangles, bold) + textWidth(ui, " tri") +
               (words.ratio.empty() ? 0.0f : gap + textWidth(ui, words.ratio));
    };
    const auto right_width = [&] {
        return words.rate.empty()
                   ? 0.0f
                   : textWidth(ui, words.rate, bold) + textWidth(ui, " fps") +
                         (words.time.empty() ? 0.0f : gap + textWidth(ui, words.time));
    };
    const auto size_width = textWidth(ui, words.size, bold);
    const auto too_wide = [&] {
        return left_width() + size_width + right_width() + 2 * gap > inner;
    };
    if (too_wide())
        words.time.clear();
    if (too_wide())
        words.triangles = formatShortCount(lane.status.numbers.triangles);
    if (too_wide())
        words.ratio.clear();
    if (too_wide())
        words.rate.clear();
    float x = area.position.x + ui.px(10);
    const auto put = [&](std::string_view text, const TextStyle& style) {
        drawText(ui, {x, y}, Align::Left, text, style);
        x += textWidth(ui, text, style.font);
    };
    put(words.triangles, {bold});
    put(" tri", {});
    x += gap;
    put(words.ratio, {nullptr, color::kSecondary});
    const float right_begin = area.end().x - ui.px(10) - right_width();
    const float centred = area.position.x + (area.size.x - size_width) * 0.5f;
    const float left_end = area.position.x + ui.px(10) + left_width() + gap;
    const float size_x =
        std::clamp(centred, left_end, std::max(left_end, right_begin - gap - size_width));
    drawText(ui, {size_x, y}, Align::Left, words.size, {bold});
    if (words.rate.empty())
        return;
    x = right_begin;
    if (!words.time.empty()) {
        put(words.time, {nullptr, color::kSecondary});
        x += gap;
    }
    put(words.rate, {bold});
    put(" fps", {});
}

namespace {

void drawBusy(const Ui& ui, const Lane& lane, double progress, const Area& area) {
    const LaneStatus& status = lane.status;
    const ImU32 colour = packed(lane.settings.colour);
    const ImVec2 middle = area.position + ImVec2(area.size.x * 0.5f, area.size.y * 0.5f);
    const bool empty = !status.lod;
    const ImVec2 at = empty ? middle - ImVec2(0, ui.px(14))
                            : ImVec2(area.end().x - ui.px(18), area.position.y + ui.px(18));
    spinner(ui, at, empty ? ui.px(11) : ui.px(7), colour);
    if (empty)
        drawText(ui,
                 {middle.x, middle.y + ui.px(8)},
                 Align::Center,
                 status.state == LaneState::Queued ? "Waiting" : "Building",
                 {nullptr, color::kSecondary});
    const ImVec2 begin{area.position.x, area.end().y - ui.px(3)};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(begin, area.end(), color::kHairline);
    list.AddRectFilled(
        begin, {begin.x + area.size.x * static_cast<float>(progress), area.end().y}, colour);
}

void drawFailure(const Ui& ui, const Lane& lane, const Area& area) {
    const ImVec2 middle = area.position + ImVec2(area.size.x * 0.5f, area.size.y * 0.5f);
    drawOnPlate(ui,
                {middle.x, middle.y - ui.px(22)},
                Align::Center,
                "Failed",
                {ui.theme.fonts.semibold, color::kError});
    drawOnPlate(ui,
                middle,
                Align::Center,
                fitText(ui, lane.status.failure, area.size.x - ui.px(36)),
                {nullptr, color::kSecondary});
    ImGui::SetCursorScreenPos({middle.x - ui.px(14), middle.y + ui.px(24)});
    if (linkButton(ui, "Retry", color::kAccent))
        ui.push(RetryLane{lane.id});
}

// Why the target was missed: a mark in the corner that tells when it is hovered; in words where
// there is room.
void drawNote(const Ui& ui, std::string_view note, const Area& area) {
    const float size = ui.px(16);
    const ImVec2 min{area.position.x + ui.px(8), area.end().y - size - ui.px(8)};
    const ImVec2 middle = min + ImVec2(size * 0.5f, size * 0.5f);
    const bool roomy = area.size.x >= ui.px(420) && area.size.y >= ui.px(240);
    if (roomy)
        drawOnPlate(ui,
                    {min.x + size + ui.px(4), middle.y - ui.px(10)},
                    Align::Left,
                    fitText(ui, note, area.size.x * 0.5f, ui.theme.fonts.small),
                    {ui.theme.fonts.small, color::kWarning});
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddCircleFilled(middle, size * 0.5f, color::kWarning, 24);
    drawText(ui,
             {middle.x, middle.y - ui.theme.fonts.semibold->FontSize * 0.5f},
             Align::Center,
             "!",
             {ui.theme.fonts.semibold, color::kBackground});
    ImGui::SetCursorScreenPos(min);
    ImGui::InvisibleButton("note", {size, size});
    ui.record("note");
    tooltip(ui, note);
}

} // namespace

void drawLaneState(
    const Ui& ui, WindowState& state, const Lane& lane, bool draft, const Area& area) {
    const LaneStatus& status = lane.status;
    if (status.state == LaneState::Building || status.state == LaneState::Queued) {
        drawBusy(ui, lane, status.progress, area);
        state.animate();
    } else if (status.texture_progress) {
        drawBusy(ui, lane, *status.texture_progress, area);
        state.animate();
    } else if (status.state == LaneState::Failed) {
        drawFailure(ui, lane, area);
    }
    if (draft && status.lod)
        drawOnPlate(ui,
                    area.position + ImVec2(ui.px(8), ui.px(6)),
                    Align::Left,
                    "draft",
                    {ui.theme.fonts.small, color::kSecondary});
    if (!status.numbers.note.empty())
        drawNote(ui, status.numbers.note, area);
}

namespace {

constexpr float kStill = 4.0f; // design pixels that a click may move

bool hasMoved(const Ui& ui) {
    const float still = ui.px(kStill);
    return ImGui::GetIO().MouseDragMaxDistanceSqr[ImGuiMouseButton_Left] >= still * still;
}

glm::dvec2 placeIn(const Area& area, const ImVec2& point) {
    return {std::clamp((point.x - area.position.x) / area.size.x, 0.0f, 1.0f),
            std::clamp((point.y - area.position.y) / area.size.y, 0.0f, 1.0f)};
}

void pickGesture(const Ui& ui, const PanelInput& input, LaneId lane, const Area& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool clicked = ImGui::IsItemDeactivated() &&
                         ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !io.KeyAlt &&
                         !hasMoved(ui);
    if (!clicked || !input.facts.pick || !input.document.scene)
        return;
    const bool adds = io.KeyShift || io.KeyCtrl;
    const bool twice = io.MouseClickedLastCount[ImGuiMouseButton_Left] > 1;
    std::optional<SelectedItem> item = input.facts.pick(lane, placeIn(area, io.MousePos));
    if (!item) {
        if (!adds)
            ui.push(Select{});
        return;
    }
    if (twice)
        item->instance = kNone;
    ui.push(Select{{*item}, adds && !twice ? Select::Mode::Toggle : Select::Mode::Replace});
}

// Returns whether a box is being dragged.
bool boxGesture(
    const Ui& ui, const PanelInput& input, WindowState& state, LaneId lane, const Area& area) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool begins = ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left) &&
                        io.KeyCtrl && !io.KeyAlt;
    if (begins)
        state.box_lane = lane;
    if (state.box_lane != lane)
        return false;
    const bool ends = !ImGui::IsItemActive();
    if (ends || ui.widgets.drag_cancelled)
        state.box_lane = kNoLane;
    if (!hasMoved(ui) || ui.widgets.drag_cancelled)
        return !ends;
    const ImVec2& begin = io.MouseClickedPos[ImGuiMouseButton_Left];
    const ImVec2 min{std::min(begin.x, io.MousePos.x), std::min(begin.y, io.MousePos.y)};
    const ImVec2 max{std::max(begin.x, io.MousePos.x), std::max(begin.y, io.MousePos.y)};
    if (ends && input.facts.pickBox) {
        const auto mode = io.KeyShift ? Select::Mode::Add : Select::Mode::Replace;
        ui.push(Select{input.facts.pickBox(lane, placeIn(area, min), placeIn(area, max)), mode});
        return false;
    }
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.PushClipRect(area.position, area.end(), true);
    list.AddRectFilled(min, max, (color::kAccent & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, 0x30));
    list.AddRect(min, max, color::kAccent, 0, 0, ui.theme.hairline());
    list.PopClipRect();
    return true;
}

void cameraGestures(const Ui& ui,
                    const PanelInput& input,
                    const WindowState& state,
                    const Area& area) {
    const bool lights = state.drag_moves_light && !ImGui::GetIO().KeyAlt &&
                        ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (const auto lit = lights ? lightGesture(input.document.view) : std::nullopt)
        ui.push(SetView{*lit});
    else if (const auto camera = cameraGesture(input.document.camera,
                                               {std::min(area.size.x, area.size.y),
                                                kVerticalFovRad,
                                                input.document.view.navigation});
             camera && !lights)
        ui.push(SetCamera{*camera});
}

} // namespace

void pictureButton(const Ui& ui, const Area& area) {
    ImGui::SetCursorScreenPos(area.position);
    ImGui::InvisibleButton("picture",
                           {std::max(1.0f, area.size.x), std::max(1.0f, area.size.y)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ImGui::SetItemAllowOverlap();
    ui.record("picture");
}

void pictureGestures(
    const Ui& ui, const PanelInput& input, WindowState& state, LaneId lane, const Area& area) {
    if (!boxGesture(ui, input, state, lane, area)) {
        cameraGestures(ui, input, state, area);
        pickGesture(ui, input, lane, area);
    }
}

void requestPicture(const PanelInput& input, WindowState& state, LaneId lane, const Area& area) {
    state.views.push_back({lane,
                           static_cast<int>(std::lround(area.size.x * input.facts.density)),
                           static_cast<int>(std::lround(area.size.y * input.facts.density))});
}

} // namespace lodestone::ui
