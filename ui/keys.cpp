#include "ui/camera_gestures.h"
#include "ui/lane_presets.h"
#include "ui/panels.h"
#include "ui/shortcuts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace lodestone::ui {

namespace {

// Key numbers as the window system's layer counts them: capitals and digits are ASCII.
constexpr int kKeyEscape = 256;
constexpr int kKeyTab = 258;
constexpr int kKeyHome = 268;
constexpr int kKeyF1 = 290;
constexpr int kKeyF11 = 300;
constexpr int kKeypad0 = 320;

constexpr double kScaleStep = 1.1;
constexpr double kShineStep = 1.25;
constexpr DragKey kAnimationDrag = 0x414e494d45ull; // a whole animation is one undo step
constexpr DragKey kStepDrag = 0x5354455053ull; // collapsing while a key is held is one undo step

constexpr std::array<Shortcut, 39> kShortcuts = {{
    {"Left drag", "orbit (also Alt+left, middle)"},
    {"Right drag", "pan (also Shift+middle)"},
    {"Wheel", "zoom"},
    {"F", "frame the selection"},
    {"Home", "frame everything"},
    {"Numpad 1 3 7", "from the front, right, above"},
    {"Numpad 5", "perspective or parallel"},
    {"1 / 0", "left drag: light / camera"},
    {"A", "animate the lane down and up"},
    {"P", "play or stop the file's animation"},
    {"Tab", "hide or show the panels"},
    {"Space", "grid, or two lanes split by a divider"},
    {"N", "normals"},
    {"T", "texel density"},
    {"L", "wireframe"},
    {"S / Shift+S", "smaller / larger"},
    {"Z / Shift+Z", "further / nearer"},
    {"M / Shift+M", "shinier / duller"},
    {"G", "floor grid"},
    {"F11", "full screen"},
    {"Click on a value", "type it"},
    {"C (hold)", "collapse 5 edges at a time"},
    {"B", "collapse one edge"},
    {"V / Shift+V", "split back two edges"},
    {"Ctrl+O", "open a file"},
    {"Ctrl+E", "export the active lane"},
    {"Ctrl+3 6 9", "IAS vs Quadric, six, all nine"},
    {"Ctrl+Z", "undo"},
    {"Ctrl+Shift+Z", "redo"},
    {"Ctrl+Q", "quit"},
    {"Click in a view", "select the instance, its lane"},
    {"Double click", "select all instances of the submesh"},
    {"Shift+click", "add to the selection, or take away"},
    {"Ctrl+drag", "select in a box; Shift adds"},
    {"Drag a header", "move the lane to another view"},
    {"View > Mouse like", "drag as in Blender or Maya"},
    {"F1", "this sheet"},
    {"Esc", "cancel drag, dialog or job, then quit"},
    {"Drop a file", "open it"},
}};

bool pressed(int key) {
    return ImGui::IsKeyPressed(key, false);
}

bool held(int key) {
    return ImGui::IsKeyPressed(key, true);
}

void controlKeys(const Ui& ui, const PanelInput& input, WindowState& state) {
    if (pressed('O'))
        openBrowser(input, state);
    if (pressed('E'))
        openExportDialog(input, state);
    if (pressed('Q'))
        state.open(Dialog::Quit);
    for (const LanePreset& preset : lanePresets())
        if (const auto ids = presetLanes(preset);
            pressed(preset.key) && input.document.scene && ids.size() > 1) {
            state.cell_count = 0;
            ui.push(SetLanes{ids});
        }
    const bool shift = ImGui::GetIO().KeyShift;
    if (held('Z') && !shift)
        ui.push(Undo{});
    if ((held('Z') && shift) || held('Y'))
        ui.push(Redo{});
}

void cameraKeys(const Ui& ui, const CameraState& camera) {
    const bool shift = ImGui::GetIO().KeyShift;
    if (pressed('F'))
        ui.push(FrameSelection{});
    if (pressed(kKeyHome))
        ui.push(FrameScene{});
    if (pressed(kKeypad0 + 1))
        ui.push(SetCamera{lookFrom(camera, AxisSide::Front)});
    if (pressed(kKeypad0 + 3))
        ui.push(SetCamera{lookFrom(camera, AxisSide::Right)});
    if (pressed(kKeypad0 + 7))
        ui.push(SetCamera{lookFrom(camera, AxisSide::Top)});
    if (pressed(kKeypad0 + 5)) {
        CameraState other = camera;
        other.orthographic = !camera.orthographic;
        ui.push(SetCamera{other});
    }
    if (held('S') || held('Z'))
        ui.push(SetCamera{zoomed(camera, shift ? 1.0 / kScaleStep : kScaleStep)});
}

void viewKeys(const Ui& ui, DisplayOptions view, WindowState& state) {
    for (const auto& [key, shading] :
         {std::pair{'N', ShadingMode::Normals}, std::pair{'T', ShadingMode::Texels}})
        if (pressed(key)) {
            view.shading = view.shading == shading ? ShadingMode::Lit : shading;
            ui.push(SetView{view});
        }
    if (pressed(' ')) {
        view.compare = view.compare == CompareMode::Split ? CompareMode::Grid : CompareMode::Split;
        ui.push(SetView{view});
    }
    if (pressed('L')) {
        view.wireframe = !view.wireframe;
        ui.push(SetView{view});
    }
    if (pressed('G')) {
        view.grid = !view.grid;
        ui.push(SetView{view});
    }
    if (held('M')) {
        const double factor = ImGui::GetIO().KeyShift ? 1.0 / kShineStep : kShineStep;
        view.shininess = std::clamp(view.shininess * factor, 0.1, 10.0);
        ui.push(SetView{view});
    }
    if (pressed('P') && state.playback.rig && !state.playback.rig->animations.empty())
        state.playback.playing = !state.playback.playing;
    if (pressed('1'))
        state.drag_moves_light = true;
    if (pressed('0'))
        state.drag_moves_light = false;
    if (pressed(kKeyTab))
        state.panels_hidden = !state.panels_hidden;
}

// The progressive-mesh viewer's keys, on the active lane.
void stepKeys(const Ui& ui, LaneId lane) {
    if (held('C'))
        ui.push(StepCollapses{lane, 5, kStepDrag});
    if (pressed('B'))
        ui.push(StepCollapses{lane, 1, kStepDrag});
    if (held('V'))
        ui.push(StepCollapses{lane, -2, kStepDrag});
    if (ImGui::IsKeyReleased('C') || ImGui::IsKeyReleased('B') || ImGui::IsKeyReleased('V'))
        ui.push(EndDrag{});
}

// The lane stays where it is.
void endAnimation(const Ui& ui, WindowState& state) {
    if (std::exchange(state.animation, {}).lane != kNoLane)
        ui.push(EndDrag{});
}

// A: down and up through the schedule of the active lane, once in kAnimationSeconds, until A again.
void animationKey(const Ui& ui, const Document& document, WindowState& state) {
    constexpr double kAnimationSeconds = 10.0;
    constexpr double kCoarsestLog10 = -2.5; // 0.3 %
    const Animation& animation = state.animation;
    const bool ends = animation.lane != kNoLane && pressed('A');
    if (ends)
        endAnimation(ui, state);
    else if (pressed('A'))
        state.animation = {document.active_lane, ImGui::GetTime()};
    const Lane* const lane = document.findLane(animation.lane);
    if (!lane || !lane->settings.algorithm)
        return;
    const double turns = (ImGui::GetTime() - animation.begin_s) / kAnimationSeconds;
    const double depth = 0.5 - 0.5 * std::cos(turns * 2.0 * std::numbers::pi);
    const double ratio = std::pow(10.0, kCoarsestLog10 * depth);
    ui.push(SlideLane{lane->id, ratio, kAnimationDrag});
    state.animate();
}

void escapeKey(const Ui& ui, const Document& document, WindowState& state) {
    if (ImGui::IsAnyMouseDown() && ImGui::IsAnyItemActive()) {
        ui.widgets.drag_cancelled = true;
        if (document.history.dragging()) {
            ui.push(EndDrag{});
            ui.push(Undo{});
        }
    } else if (state.welcome) {
        state.welcome = false;
    } else if (!document.jobs.empty()) {
        ui.push(CancelJob{0});
    } else {
        state.open(Dialog::Quit);
    }
}

} // namespace

std::span<const Shortcut> shortcuts() {
    return kShortcuts;
}

void handleKeys(const Ui& ui, const PanelInput& input, WindowState& state) {
    if (!ImGui::IsAnyMouseDown())
        ui.widgets.drag_cancelled = false;
    if (pressed(kKeyF11))
        state.full_screen_toggled = true;
    const bool popup =
        ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    if (popup || state.dialog != Dialog::None || ImGui::GetIO().WantTextInput) {
        endAnimation(ui, state); // what is exported must not slide
        return;
    }
    const Document& document = input.document;
    if (pressed(kKeyF1))
        state.open(Dialog::Shortcuts);
    if (pressed(kKeyEscape))
        escapeKey(ui, document, state);
    if (ImGui::GetIO().KeyCtrl) {
        controlKeys(ui, input, state);
        return;
    }
    if (!document.scene)
        return;
    cameraKeys(ui, document.camera);
    viewKeys(ui, document.view, state);
    stepKeys(ui, document.active_lane);
    animationKey(ui, document, state);
}

} // namespace lodestone::ui
