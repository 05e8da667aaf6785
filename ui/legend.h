#pragma once
// What colours over a picture mean, and the lane's number. ui.panel names the view.
#include "ui/panels.h"
#include "ui/widgets.h"

namespace lodestone::ui {

// Over a picture, on a plate that keeps it readable on every background. position: the plate's top
// left, or the middle of its top. Returns the plate's lower right corner.
ImVec2 drawOnPlate(const Ui& ui,
                   const ImVec2& position,
                   Align align,
                   std::string_view text,
                   const TextStyle& style);

// In the modes that show numbers as colours: the lane's number at the upper left of a picture, the
// scale with its units at its lower edge. Else nothing.
void drawLegend(const Ui& ui, const Document& document, const Lane& lane, const Area& area);

} // namespace lodestone::ui
