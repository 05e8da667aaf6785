#include "scene/generate.h"
#include "ui/camera_gestures.h"
#include "ui/lane_presets.h"
#include "ui/lane_text.h"
#include "ui/panels.h"
#include "ui/target_slider.h"
#include "ui/widgets.h"

#include <array>
#include <cmath>

namespace lodestone::ui {

namespace {

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
    constexpr std::array kShadings = {ShadingMode::Lit,
                                      ShadingMode::Clay,
                                      ShadingMode::Flat,
                                      ShadingMode::Normals,
                                      ShadingMode::UvChecker,
                                      ShadingMode::Submesh,
                                      ShadingMode::Instance};
    DisplayOptions view = document.view;
    for (const ShadingMode shading : kShadings)
        if (menuItem(ui,
                     "Shading: " + std::string(shadingName(shading)),
                     shading == ShadingMode::Normals ? "N" : nullptr,
                     view.shading == shading)) {
            view.shading = shading;
            ui.push(SetView{view});
        }
    if (menuItem(ui, "Wireframe", "L", view.wireframe)) {
        view.wireframe = !view.wireframe;
        ui.push(SetView{view});
    }
    const bool split = view.compare == CompareMode::Split;
    if (menuItem(ui, "Split", "Space", split)) {
        view.compare = split ? CompareMode::Grid : CompareMode::Split;
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
    ImGui::PopStyleVar();
    ui.panel = outer;
    ImGui::EndMenu();
}

// At the right: what "equal" means for the master slider, and how many views the grid has.
void drawSwitches(const Ui& ui, const PanelInput& input, WindowState& state) {
    constexpr std::array<std::string_view, 2> kEqual = {"triangles", "bytes"};
    constexpr std::array<std::string_view, 2> kEqualTips = {
        "The master slider gives every lane the same number of triangles.",
        "The master slider gives every lane the same exported size."};
    constexpr std::array<std::string_view, 6> kCounts = {"1", "2", "3", "4", "6", "9"};
    const Document& document = input.document;
    const float counts_width = segmentedWidth(ui, kCounts);
    const float equal_width = segmentedWidth(ui, kEqual);
    const float y = ui.px(4);
    const float counts_x =
        static_cast<float>(ImGui::GetIO().DisplaySize.x) - counts_width - ui.px(12);
    const float equal_x = counts_x - equal_width - ui.px(20);
    drawText(
        ui, {equal_x - ui.px(10), ui.px(7)}, Align::Right, "equal", {nullptr, color::kSecondary});
    ImGui::SetCursorScreenPos({equal_x, y});
    const bool bytes = document.master.kind == Target::Kind::Bytes;
    if (segmented(ui, {"Equal", kEqual, bytes ? 1 : 0, kEqualTips})) {
        const Lane* const lane = document.findLane(document.active_lane);
        const Target::Kind kind = bytes ? Target::Kind::Ratio : Target::Kind::Bytes;
        if (lane && lane->status.lod)
            ui.push(SetMasterTarget{sameTarget(*lane, kind)});
    }
    ImGui::SetCursorScreenPos({counts_x, y});
    const int shown =
        state.cell_count > 0 ? state.cell_count : static_cast<int>(document.lanes.size());
    int selected = -1;
    for (std::size_t at = 0; at < kCounts.size(); ++at)
        if (kCounts[at] == std::to_string(shown))
            selected = static_cast<int>(at);
    if (const auto chosen = segmented(ui, {"Views", kCounts, selected, {}}))
        state.cell_count = kCounts[static_cast<std::size_t>(*chosen)][0] - '0';
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
    const Target& target = input.document.master;
    const std::string value = formatTarget(target);
    const float label_width = ui.px(64);
    const float value_width = ui.px(78);
    const float left = area.position.x + ui.px(12);
    const float right = area.end().x - ui.px(12);
    drawText(ui, {left, text_y}, Align::Left, "All lanes", {nullptr, color::kSecondary});
    drawText(ui, {right, text_y}, Align::Right, value, {ui.theme.fonts.semibold});
    ImGui::SetCursorScreenPos(
        {left + label_width, area.position.y + (area.size.y - ui.px(16)) * 0.5f});
    if (input.document.scene)
        masterSlider(ui, input, state, right - left - label_width - value_width);
    horizontalHairline(ui, area.position.x, area.end().x, area.end().y - ui.theme.hairline());
    endPanel();
    ImGui::PopStyleVar();
}

} // namespace lodestone::ui
