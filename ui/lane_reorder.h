#pragma once
// Lanes are moved by dragging the header of a view onto another view.
#include "ui/panels.h"

namespace lodestone::ui {

struct LaneCell {
    LaneId lane = kNoLane; // kNoLane: a free cell
    Area area;
};

// The place to drag the lane by; a click makes it the active one. ui.panel names the view.
void laneHandle(
    const Ui& ui, const Document& document, WindowState& state, const Lane& lane, const Area& area);
// While a lane is dragged: where it would go, and once it is let go there, the move. cells: of the
// grid, in its order; the lane takes the place of the one it is dropped on. Esc leaves all as it
// is.
void dragLane(const Ui& ui,
              const Document& document,
              WindowState& state,
              std::span<const LaneCell> cells);

} // namespace lodestone::ui
