#pragma once
// The inspector's control of one parameter of a lane's algorithm.
#include "ui/ui.h"

namespace lodestone::ui {

// A slider, a toggle or a box of choices, as the parameter's row says. Nothing where the parameter
// means nothing because another is 0.
void parameterControl(const Ui& ui, const Lane& lane, const ParameterInfo& parameter);

} // namespace lodestone::ui
