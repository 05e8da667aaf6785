#pragma once
// The parts of the window. Each reads the document and emits commands; none simplifies or draws
// the scene. Positions and sizes in window units. Main thread, between NewFrame and Render.
#include "ui/window_state.h"

namespace lodestone::ui {

struct Area {
    ImVec2 position;
    ImVec2 size;

    ImVec2 end() const { return {position.x + size.x, position.y + size.y}; }
};

// What the layout depends on besides the size of the window.
struct LayoutNeeds {
    bool panels_hidden = false;
    std::size_t lane_count = 0; // rows of the table, shown where the window is high enough
};

// Where the parts are at the window's present size.
struct Layout {
    Area menu;
    Area scene;
    Area master; // strip above the views
    Area grid;
    Area inspector;
    Area compare;
    Area status;
};

Layout layoutOf(const Theme& theme, const ImVec2& window_size, const LayoutNeeds& needs);

void drawMenuBar(Ui ui, const PanelInput& input, WindowState& state);
void drawScenePanel(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawMasterStrip(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawLaneGrid(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawInspector(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawComparePanel(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawLaneChart(const Ui& ui,
                   const PanelInput& input,
                   const WindowState& state,
                   ChartKind kind,
                   const Area& area);
void drawStatusBar(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawToast(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
// Play, the animation's name and its time, over the views; nothing for a scene that cannot move.
void drawPlayback(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
void drawWelcome(Ui ui, const PanelInput& input, WindowState& state, const Area& area);
// Open, Export, Shortcuts, About, Quit: whichever state.dialog names.
void drawDialogs(Ui ui, const PanelInput& input, WindowState& state);
// Keys that no widget took.
void handleKeys(const Ui& ui, const PanelInput& input, WindowState& state);

// Opens the dialog with its fields filled in.
void openBrowser(const PanelInput& input, WindowState& state);
void openExportDialog(const PanelInput& input, WindowState& state);

} // namespace lodestone::ui
