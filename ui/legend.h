#pragma once
// What colours over a picture mean, and the lane's number. ui.panel names the view.
#include "ui/panels.h"

namespace lodestone::ui {

// In the modes that show numbers as colours, at the upper edge of a picture: the lane's number at
// the left, where there is room the scale with its units at the right. Else nothing.
void drawLegend(const Ui& ui, const Document& document, const Lane& lane, const Area& area);

} // namespace lodestone::ui
