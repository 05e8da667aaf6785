#include "ui/window.h"

#include "ui/panels.h"

namespace lodestone::ui {

namespace {

// The switches that a test cannot read off the document.
void logState(UiLog& log, const WindowState& state, const Document& document) {
    if (!log.enabled())
        return;
    const DisplayOptions& view = document.view;
    const std::string members =
        "\"dialog\":" + std::to_string(static_cast<int>(state.dialog)) +
        ",\"welcome\":" + (state.welcome ? "true" : "false") +
        ",\"panels_hidden\":" + (state.panels_hidden ? "true" : "false") +
        ",\"views\":" + std::to_string(state.views.size()) +
        ",\"wireframe\":" + (view.wireframe ? "true" : "false") + ",\"compare\":\"" +
        std::string(compareName(view.compare)) + "\",\"grid\":" + (view.grid ? "true" : "false") +
        ",\"playing\":" + (state.playback.playing ? "true" : "false") +
        ",\"time_s\":" + std::to_string(view.moment.time_s) +
        ",\"shininess\":" + std::to_string(view.shininess) +
        ",\"error_chart\":" + (state.chart == ChartKind::Error ? "true" : "false") +
        ",\"width\":" + std::to_string(ImGui::GetIO().DisplaySize.x) +
        ",\"azimuth\":" + std::to_string(document.camera.azimuth_deg) +
        ",\"distance\":" + std::to_string(document.camera.distance) +
        ",\"light_azimuth\":" + std::to_string(view.light_azimuth_deg) + ",\"shading\":\"" +
        std::string(shadingName(view.shading)) + "\"";
    log.object("window", "state", members);
}

} // namespace

Window::Window(Session& session, const Theme& theme, const Options& options)
    : session_(session), theme_(theme) {
    state_.welcome = options.welcome;
}

void Window::draw(const WindowFacts& facts,
                  std::span<const LanePicture> pictures,
                  CommandQueue& commands) {
    state_.wake_in_s = WindowState::kNever;
    const Document& document = session_.document();
    state_.curves.update(document);
    if (state_.curves.busy())
        state_.animate();
    const PanelInput input{session_, document, pictures, facts};
    const Ui ui{theme_, session_.uiLog(), commands, widgets_, {}};
    const Layout layout =
        layoutOf(theme_, ImGui::GetIO().DisplaySize, {state_.panels_hidden, document.lanes.size()});
    ImGui::PushFont(theme_.fonts.regular);
    handleKeys(ui, input, state_);
    drawMenuBar(ui, input, state_);
    drawMasterStrip(ui, input, state_, layout.master);
    drawLaneGrid(ui, input, state_, layout.grid);
    if (!state_.panels_hidden) {
        drawScenePanel(ui, input, state_, layout.scene);
        drawInspector(ui, input, state_, layout.inspector);
        drawComparePanel(ui, input, state_, layout.compare);
    }
    drawStatusBar(ui, input, state_, layout.status);
    drawPlayback(ui, input, state_, layout.grid);
    drawWelcome(ui, input, state_, layout.grid);
    drawToast(ui, input, state_, layout.grid);
    drawDialogs(ui, input, state_);
    if (ImGui::GetIO().WantTextInput)
        state_.wakeIn(0.4); // the caret blinks
    ImGui::PopFont();
    logState(session_.uiLog(), state_, document);
}

void Window::drop(std::span<const std::filesystem::path> files, CommandQueue& commands) {
    if (files.empty())
        return;
    state_.welcome = false;
    commands.push(OpenScene{files.front()});
}

} // namespace lodestone::ui
