#include "scene/generate.h"
#include "ui/camera_gestures.h"
#include "ui/display_menu.h"
#include "ui/lane_presets.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/target_slider.h"
#include "ui/widgets.h"

#include <array>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr std::array<std::string_view, 5> kCompareTitles = {
    "Grid", "Split", "Flicker", "Heat map", "Difference"};
constexpr std::array<std::string_view, 5> kCompareTips = {
    "Every lane beside the others.",
    "The active lane and the original, with a divider to drag between them.",
    "The active lane and the original in turn at one place, twice a second.",
    "Every vertex in the colour of its distance to the original's surface.",
    "Every pixel in the colour of its difference (FLIP) from the original's picture; the lane's "
    "number is the mean."};

void fileMenu(const Ui& ui, const PanelInput& input, WindowState& state) {
    const Document& document = input.document;
    if (menuItem(ui, "Open\u2026", "Ctrl+O"))
        openBrowser(input, state);
    if (ImGui::BeginMenu("Open recent", !document.recent.empty())) {
        for (const std::filesystem::path& file : document.recent)
            if (menuItem(ui, file.string(), nullptr))
                ui.push(OpenScene{file});
        ImGui::EndMenu();
    }
    ui.record("Open recent");
    if (ImGui::BeginMenu("Samples")) {
        for (const std::string_view name : sampleNames())
            if (menuItem(ui, name, nullptr))
                ui.push(OpenSample{std::string(name), 1});
        ImGui::EndMenu();
    }
    ui.record("Samples");
    ImGui::Separator();
    if (menuItem(ui, "Export LOD\u2026", "Ctrl+E", false, document.scene != nullptr))
        openExportDialog(input, state);
    ImGui::Separator();
    if (menuItem(ui, "Quit", "Ctrl+Q"))
        state.open(Dialog::Quit);
}

void editMenu(const Ui& ui, const Document& document) {
    const History& history = document.history;
    const auto named = [](std::string_view verb, std::string_view step) {
        return std::string(verb) + (step.empty() ? "" : " ") + std::string(step);
    };
    if (menuItem(ui, named("Undo", history.undoName()), "Ctrl+Z", false, history.canUndo()))
        ui.push(Undo{});
    if (menuItem(ui, named("Redo", history.redoName()), "Ctrl+Shift+Z", false, history.canRedo()))
        ui.push(Redo{});
}

void viewMenu(const Ui& ui, const Document& document, WindowState& state) {
    displayItems(ui, document.view);
    ImGui::Separator();
    for (std::size_t mode = 0; mode < kCompareTitles.size(); ++mode) {
        DisplayOptions view = document.view;
        view.compare = static_cast<CompareMode>(mode);
        if (menuItem(ui,
                     "Compare: " + std::string(kCompareTitles[mode]),
                     view.compare == CompareMode::Split ? "Space" : nullptr,
                     view.compare == document.view.compare))
            ui.push(SetView{view});
    }
    ImGui::Separator();
    if (menuItem(ui, "Frame all", "Home"))
        ui.push(FrameScene{});
    if (menuItem(ui, "Frame selection", "F"))
        ui.push(FrameSelection{});
    if (menuItem(ui, "From the front", "Numpad 1"))
        ui.push(SetCamera{lookFrom(document.camera, AxisSide::Front)});
    if (menuItem(ui, "From the right", "Numpad 3"))
        ui.push(SetCamera{lookFrom(document.camera, AxisSide::Right)});
    if (menuItem(ui, "From above", "Numpad 7"))
        ui.push(SetCamera{lookFrom(document.camera, AxisSide::Top)});
    if (menuItem(ui, "Parallel projection", "Numpad 5", document.camera.orthographic)) {
        CameraState other = document.camera;
        other.orthographic = !other.orthographic;
        ui.push(SetCamera{other});
    }
    ImGui::Separator();
    if (menuItem(ui, "Panels", "Tab", !state.panels_hidden))
        state.panels_hidden = !state.panels_hidden;
    if (menuItem(ui, "Full screen", "F11"))
        state.full_screen_toggled = true;
}

void lanesMenu(const Ui& ui, const Document& document, WindowState& state) {
    const LaneId active = document.active_lane;
    const bool open = document.scene != nullptr;
    for (const LanePreset& preset : lanePresets()) {
        const std::vector<std::string> ids = presetLanes(preset);
        if (menuItem(ui, preset.name, preset.shortcut, false, open && ids.size() > 1)) {
            state.cell_count = 0;
            ui.push(SetLanes{ids});
        }
    }
    ImGui::Separator();
    if (ImGui::BeginMenu("Add lane", document.scene != nullptr)) {
        if (menuItem(ui, "Original", nullptr))
            ui.push(AddLane{});
        for (const Algorithm& algorithm : algorithms())
            if (menuItem(ui, algorithm.name, nullptr))
                ui.push(AddLane{std::string(algorithm.id)});
        ImGui::EndMenu();
    }
    ui.record("Add lane");
    if (menuItem(ui, "Duplicate lane", nullptr, false, active != kNoLane))
        ui.push(DuplicateLane{active});
    if (menuItem(ui, "Remove lane", nullptr, false, document.lanes.size() > 1))
        ui.push(RemoveLane{active});
}

void lodMenu(const Ui& ui, const PanelInput& input, WindowState& state) {
    const Document& document = input.document;
    const bool open = document.scene != nullptr;
    if (menuItem(ui, "Export LOD\u2026", "Ctrl+E", false, open))
        openExportDialog(input, state);
    if (menuItem(ui, "Measure distance of all lanes", nullptr, false, open))
        ui.push(MeasureLane{kNoLane});
    ImGui::Separator();
    if (menuItem(ui, "Collapse one edge", "B", false, open))
        ui.push(StepCollapses{document.active_lane, 1});
    if (menuItem(ui, "Split back two edges", "V", false, open))
        ui.push(StepCollapses{document.active_lane, -2});
    ImGui::Separator();
    if (menuItem(ui, "Cancel all jobs", "Esc", false, !document.jobs.empty()))
        ui.push(CancelJob{0});
}

// One menu of the bar; recorded by its name.
template <class Body>
void menu(Ui& ui, const char* name, Body body) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.px(9), ui.px(7)});
    const bool open = ImGui::BeginMenu(name);
    ui.record(name);
    ImGui::PopStyleVar();
    if (!open)
        return;
    const std::string outer = ui.panel;
    ui.panel += std::string("/") + name;
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ui.px(10), ui.px(7)});
    body();
    closeOnEscape();
    ImGui::PopStyleVar();
    ui.panel = outer;
    ImGui::EndMenu();
}

// What "equal" means for the master slider.
void equalSwitch(const Ui& ui, const Document& document) {
    constexpr std::array<std::string_view, 3> kEqual = {"triangles", "bytes", "pixels"};
    constexpr std::array<std::string_view, 3> kTips = {
        "The master slider gives every lane the same number of triangles.",
        "The master slider gives every lane the same exported size.",
        "The master slider gives every lane the same error on screen, in pixels of a view; it "
        "follows the camera."};
    const int selected = document.master_px                            ? 2
                         : document.master.kind == Target::Kind::Bytes ? 1
                                                                       : 0;
    const auto chosen = segmented(ui, {"Equal", kEqual, selected, kTips});
    const Lane* const lane = document.findLane(document.active_lane);
    if (!chosen || !lane || !lane->status.lod)
        return;
    if (*chosen == 2)
        ui.push(SetMasterPixels{shownPixels(document, *lane)});
    else
        ui.push(SetMasterTarget{
            sameTarget(*lane, *chosen == 1 ? Target::Kind::Bytes : Target::Kind::Ratio)});
}

// At the right: what is equal, how many views the grid has, how lanes are compared.
void drawSwitches(const Ui& ui, const PanelInput& input, WindowState& state) {
    constexpr std::array<std::string_view, 3> kEqualWidths = {"triangles", "bytes", "pixels"};
    constexpr std::array<std::string_view, 6> kCounts = {"1", "2", "3", "4", "6", "9"};
    const Document& document = input.document;
    const float y = ui.px(4);
    const float gap = ui.px(14);
    const float modes_x =
        ImGui::GetIO().DisplaySize.x - segmentedWidth(ui, kCompareTitles) - ui.px(12);
    const float counts_x = modes_x - segmentedWidth(ui, kCounts) - gap;
    const float equal_x = counts_x - segmentedWidth(ui, kEqualWidths) - gap;
    drawText(
        ui, {equal_x - ui.px(8), ui.px(7)}, Align::Right, "equal", {nullptr, color::kSecondary});
    ImGui::SetCursorScreenPos({equal_x, y});
    equalSwitch(ui, document);
    ImGui::SetCursorScreenPos({counts_x, y});
    const int shown =
        state.cell_count > 0 ? state.cell_count : static_cast<int>(document.lanes.size());
    int selected = -1;
    for (std::size_t at = 0; at < kCounts.size(); ++at)
        if (kCounts[at] == std::to_string(shown))
            selected = static_cast<int>(at);
    if (const auto chosen = segmented(ui, {"Views", kCounts, selected, {}}))
        state.cell_count = kCounts[static_cast<std::size_t>(*chosen)][0] - '0';
    ImGui::SetCursorScreenPos({modes_x, y});
    const auto mode = static_cast<int>(document.view.compare);
    if (const auto chosen = segmented(ui, {"Compare", kCompareTitles, mode, kCompareTips})) {
        DisplayOptions view = document.view;
        view.compare = static_cast<CompareMode>(*chosen);
        ui.push(SetView{view});
    }
}

} // namespace

void drawMenuBar(Ui ui, const PanelInput& input, WindowState& state) {
    ui.panel = "Menu";
    const float padding = std::round((ui.px(30) - ImGui::GetFontSize()) * 0.5f);
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ui.px(8), padding});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {ui.px(10), ui.px(8)});
    if (ImGui::BeginMainMenuBar()) {
        const ImVec2 mark{ui.px(12), padding};
        drawText(ui, mark, Align::Left, "Lodestone", {ui.theme.fonts.semibold, color::kAccent});
        ImGui::SetCursorPosX(mark.x + textWidth(ui, "Lodestone", ui.theme.fonts.semibold) +
                             ui.px(16));
        menu(ui, "File", [&] { fileMenu(ui, input, state); });
        menu(ui, "Edit", [&] { editMenu(ui, input.document); });
        menu(ui, "View", [&] { viewMenu(ui, input.document, state); });
        menu(ui, "Lanes", [&] { lanesMenu(ui, input.document, state); });
        menu(ui, "LOD", [&] { lodMenu(ui, input, state); });
        menu(ui, "Help", [&] {
            if (menuItem(ui, "Keys and mouse", "F1"))
                state.open(Dialog::Shortcuts);
            if (menuItem(ui, "Welcome", nullptr))
                state.welcome = true;
            if (menuItem(ui, "About Lodestone", nullptr))
                state.open(Dialog::About);
        });
        drawSwitches(ui, input, state);
        horizontalHairline(ui, 0, ImGui::GetIO().DisplaySize.x, ui.px(30) - ui.theme.hairline());
        ImGui::EndMainMenuBar();
    }
    ImGui::PopStyleVar(2);
}

void drawMasterStrip(Ui ui, const PanelInput& input, WindowState& state, const Area& area) {
    ui.panel = "Master";
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    beginPanel("Master", area.position, area.size, PanelScroll::None);
    const float text_y = area.position.y + (area.size.y - ImGui::GetTextLineHeight()) * 0.5f;
    const std::string value = masterText(input.document);
    const float label_width = ui.px(64);
    const float value_width = ui.px(78);
    const float left = area.position.x + ui.px(12);
    const float middle = area.position.y + area.size.y * 0.5f;
    const float right = displayButton(ui, input, area.end().x - ui.px(12), middle) - ui.px(16);
    if (input.document.scene) {
        drawText(ui, {left, text_y}, Align::Left, "All lanes", {nullptr, color::kSecondary});
        drawText(ui, {right, text_y}, Align::Right, value, {ui.theme.fonts.semibold});
        ImGui::SetCursorScreenPos(
            {left + label_width, area.position.y + (area.size.y - ui.px(16)) * 0.5f});
        masterSlider(ui, input, state, right - left - label_width - value_width);
    }
    horizontalHairline(ui, area.position.x, area.end().x, area.end().y - ui.theme.hairline());
    endPanel();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
