#include "ui/camera_gestures.h"
#include "ui/format.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/widgets.h"

#include <algorithm>
#include <cmath>

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

void drawHeader(
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
    const float menu_width = ui.px(26);
    const float menu_x = area.end().x - menu_width - ui.px(4);
    drawText(ui,
             {x, text_y},
             Align::Left,
             fitText(ui, laneSummary(input.document, lane), std::max(0.0f, menu_x - x)),
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
    if (ImGui::BeginPopup("lane menu")) {
        laneMenu(ui, input, state, lane);
        ImGui::EndPopup();
    }
}

struct FooterWords {
    std::string triangles;
    std::string ratio;
    std::string size;
    std::string time;
    std::string rate;
};

FooterWords footerWords(const Lane& lane) {
    const LaneNumbers& numbers = lane.status.numbers;
    FooterWords words;
    if (!lane.status.lod)
        return words;
    words.triangles = formatCount(numbers.triangles);
    words.ratio = formatRatio(numbers.ratio);
    words.size = formatBytes(numbers.predicted_bytes);
    if (lane.status.frame_ms > 0.0) {
        words.time = formatMilliseconds(lane.status.frame_ms);
        words.rate = formatRate(framesPerSecond(lane));
    }
    return words;
}

// Left: triangles and ratio; middle: size; right: time and rate. What does not fit is left out.
void drawFooter(const Ui& ui, const Lane& lane, const Area& area) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(area.position, area.end(), color::kPanel);
    const float y = area.position.y + (area.size.y - ImGui::GetTextLineHeight()) * 0.5f;
    const float inner = area.size.x - ui.px(20);
    FooterWords words = footerWords(lane);
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

// Over the picture: what the lane is busy with, or why it shows nothing.
void drawState(const Ui& ui, WindowState& state, const Lane& lane, bool draft, const Area& area) {
    const LaneStatus& status = lane.status;
    const ImU32 colour = packed(lane.settings.colour);
    const bool busy = status.state == LaneState::Building || status.state == LaneState::Queued;
    const ImVec2 middle = area.position + ImVec2(area.size.x * 0.5f, area.size.y * 0.5f);
    if (busy) {
        const bool empty = !status.lod;
        const ImVec2 at = empty ? middle - ImVec2(0, ui.px(14))
                                : ImVec2(area.end().x - ui.px(18), area.position.y + ui.px(18));
        spinner(ui, at, empty ? ui.px(11) : ui.px(7), colour);
        const char* const words = status.state == LaneState::Queued ? "Waiting" : "Building";
        if (empty)
            drawText(ui,
                     {middle.x, middle.y + ui.px(8)},
                     Align::Center,
                     words,
                     {nullptr, color::kSecondary});
        state.animate();
        const float line = ui.px(3);
        const ImVec2 begin{area.position.x, area.end().y - line};
        ImDrawList& list = *ImGui::GetWindowDrawList();
        list.AddRectFilled(begin, area.end(), color::kHairline);
        list.AddRectFilled(
            begin,
            {begin.x + area.size.x * static_cast<float>(status.progress), area.end().y},
            colour);
    } else if (status.state == LaneState::Failed) {
        drawText(ui,
                 {middle.x, middle.y - ui.px(20)},
                 Align::Center,
                 "Failed",
                 {ui.theme.fonts.semibold, color::kError});
        drawText(ui,
                 middle,
                 Align::Center,
                 fitText(ui, status.failure, area.size.x - ui.px(24)),
                 {nullptr, color::kSecondary});
        ImGui::SetCursorScreenPos({middle.x - ui.px(14), middle.y + ui.px(22)});
        if (linkButton(ui, "Retry", color::kAccent))
            ui.push(RetryLane{lane.id});
    }
    if (draft && status.lod)
        drawText(ui,
                 area.position + ImVec2(ui.px(10), ui.px(8)),
                 Align::Left,
                 "draft",
                 {ui.theme.fonts.small, color::kSecondary});
    if (!status.numbers.note.empty()) {
        const float y = area.end().y - ui.px(22);
        drawText(ui,
                 {area.position.x + ui.px(10), y},
                 Align::Left,
                 fitText(ui, status.numbers.note, area.size.x - ui.px(20), ui.theme.fonts.small),
                 {ui.theme.fonts.small, color::kWarning});
    }
}

void drawPicture(
    const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane, const Area& area) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(area.position, area.end(), color::kView);
    const LanePicture* const picture = input.pictureOf(lane.id);
    if (picture && picture->texture)
        list.AddImage(picture->texture, area.position, area.end(), {0, 1}, {1, 0});
    ImGui::SetCursorScreenPos(area.position);
    ImGui::InvisibleButton("picture",
                           {std::max(1.0f, area.size.x), std::max(1.0f, area.size.y)},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight |
                               ImGuiButtonFlags_MouseButtonMiddle);
    ImGui::SetItemAllowOverlap();
    ui.record("picture");
    if (ImGui::IsItemActivated())
        ui.push(SetActiveLane{lane.id});
    const bool lights = state.drag_moves_light && ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (const auto lit = lights ? lightGesture(input.document.view) : std::nullopt)
        ui.push(SetView{*lit});
    else if (const auto camera = cameraGesture(
                 input.document.camera, std::min(area.size.x, area.size.y), kVerticalFovRad);
             camera && !lights)
        ui.push(SetCamera{*camera});
    drawState(ui, state, lane, picture && picture->draft, area);
    state.views.push_back({lane.id,
                           static_cast<int>(std::lround(area.size.x * input.facts.density)),
                           static_cast<int>(std::lround(area.size.y * input.facts.density))});
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
    drawHeader(named, input, state, lane, {area.position, {area.size.x, header}});
    drawFooter(named, lane, {{area.position.x, area.end().y - footer}, {area.size.x, footer}});
    if (lane.id == input.document.active_lane && input.document.lanes.size() > 1)
        ImGui::GetWindowDrawList()->AddRect(
            area.position, area.end(), color::kAccent, 0, 0, std::max(1.0f, ui.px(1.5f)));
    ImGui::PopID();
}

// A cell without a lane: what could be there.
void drawFreeCell(const Ui& ui, const Area& area) {
    const auto rows = static_cast<float>(algorithms().size() + 1);
    const float line = ui.px(26);
    ImVec2 at{area.position.x + area.size.x * 0.5f - ui.px(70),
              area.position.y + (area.size.y - rows * line) * 0.5f};
    drawText(ui, at, Align::Left, "Add a lane", {nullptr, color::kSecondary});
    for (const Algorithm& algorithm : algorithms()) {
        at.y += line;
        if (at.y + line > area.end().y)
            return;
        ImGui::GetWindowDrawList()->AddCircleFilled(
            at + ImVec2(ui.px(4), ui.px(8)), ui.px(4), packed(laneColour(&algorithm, 0)), 24);
        ImGui::SetCursorScreenPos(at + ImVec2(ui.px(16), 0));
        if (linkButton(ui, algorithm.name))
            ui.push(AddLane{std::string(algorithm.id)});
    }
}

} // namespace

void drawLaneGrid(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Grid";
    state.views.clear();
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::PushStyleColor(ImGuiCol_WindowBg, color::kView);
    beginPanel("Grid", area.position, area.size, PanelScroll::None);
    const std::vector<const Lane*> lanes = shownLanes(input.document, state.cell_count);
    const int count = std::max({1, state.cell_count, static_cast<int>(lanes.size())});
    const auto bars = static_cast<double>(ui.px(2 * kBarHeight));
    const Cells cells =
        arrange(count, static_cast<double>(area.size.x), static_cast<double>(area.size.y), bars);
    const float line = ui.theme.hairline();
    for (int at = 0; at < count && input.document.scene; ++at) {
        const auto column = static_cast<float>(at % cells.columns);
        const int row_index = at / cells.columns;
        const auto row = static_cast<float>(row_index);
        const ImVec2 step{area.size.x / static_cast<float>(cells.columns),
                          area.size.y / static_cast<float>(cells.rows)};
        const ImVec2 begin{std::round(area.position.x + column * step.x),
                           std::round(area.position.y + row * step.y)};
        const ImVec2 end{std::round(area.position.x + (column + 1) * step.x),
                         std::round(area.position.y + (row + 1) * step.y)};
        const Area cell{begin,
                        end - begin -
                            ImVec2(column + 1 < static_cast<float>(cells.columns) ? line : 0,
                                   row + 1 < static_cast<float>(cells.rows) ? line : 0)};
        if (static_cast<std::size_t>(at) < lanes.size())
            drawCell(ui, input, state, *lanes[static_cast<std::size_t>(at)], cell);
        else
            drawFreeCell(ui, cell);
        if (column + 1 < static_cast<float>(cells.columns))
            verticalHairline(ui, end.x - line, begin.y, end.y);
        if (row + 1 < static_cast<float>(cells.rows))
            horizontalHairline(ui, begin.x, end.x, end.y - line);
    }
    endPanel();
    ImGui::PopStyleColor();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
