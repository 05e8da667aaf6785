#pragma once
// The parts of one lane's view, for the grid and the split view. ui.panel names the view.
#include "ui/panels.h"

namespace lodestone::ui {

constexpr float kLaneMenuWidth = 30.0f; // at the right end of a header, in design pixels

// Name, what sets the lane apart, its distances if they are measured, and its menu.
void drawLaneHeader(
    const Ui& ui, const PanelInput& input, WindowState& state, const Lane& lane, const Area& area);
// Triangles and ratio, size, time and rate. What does not fit is shortened, then left out.
void drawLaneFooter(const Ui& ui, const Document& document, const Lane& lane, const Area& area);
// Over the picture: what the lane is busy with, or why it shows nothing.
void drawLaneState(
    const Ui& ui, WindowState& state, const Lane& lane, bool draft, const Area& area);
// Takes the mouse over a picture; what is drawn over it may take it back.
void pictureButton(const Ui& ui, const Area& area);
// What the mouse does over the last ImGui item, a picture of the lane. Drags move camera or light;
// with Ctrl they select what is in a box, with Shift besides what is selected already. A click
// selects the instance that is there, with Shift or Ctrl it adds it or takes it away; a double
// click selects all instances of its submesh.
void pictureGestures(
    const Ui& ui, const PanelInput& input, WindowState& state, LaneId lane, const Area& area);
// Asks for the lane's picture in the size of the area.
void requestPicture(const PanelInput& input, WindowState& state, LaneId lane, const Area& area);

// Two lanes in one place: left of a divider the one, right of it the other.
void drawSplitView(const Ui& ui, const PanelInput& input, WindowState& state, const Area& area);
// The same two lanes in turn.
void drawFlickerView(const Ui& ui, const PanelInput& input, WindowState& state, const Area& area);

} // namespace lodestone::ui
