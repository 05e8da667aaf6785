#pragma once
// How the views look: shading, edges, floor, background, colours, light, mouse habits.
#include "ui/panels.h"

namespace lodestone::ui {

// The words for a mode of shading, as menus show it.
std::string_view shadingTitle(ShadingMode shading);

// The items of a menu or popup that is open. Emits SetView.
void displayItems(const Ui& ui, const DisplayOptions& view);

// A button, right-aligned at `right`, that opens them. Returns its left edge.
float displayButton(const Ui& ui, const PanelInput& input, float right, float middle);

} // namespace lodestone::ui
