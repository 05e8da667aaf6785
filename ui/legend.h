#pragma once
// What colours over a picture mean, and the lane's number. ui.panel names the view.
#include "ui/panels.h"

namespace lodestone::ui {

// In the modes that show numbers as colours: the lane's number at the upper left of a picture, the
// scale with its units at its lower edge. Else nothing.
void drawLegend(const Ui& ui, const Document& document, const Lane& lane, const Area& area);

} // namespace lodestone::ui
