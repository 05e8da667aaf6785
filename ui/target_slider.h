#pragma once
// Sliders for targets, shared by the master strip, the compare table and the inspector.
#include "ui/target_scale.h"
#include "ui/window_state.h"

namespace lodestone::ui {

// Of any lane at full detail, as far as known; at least the original's.
std::uint64_t largestBytes(const PanelInput& input, const WindowState& state);

// The lane's own slider: emits SetLaneTarget and EndDrag. width: of the track alone; 0: with label
// and value over the panel's width.
void laneTargetSlider(
    const Ui& ui, const PanelInput& input, const WindowState& state, const Lane& lane, float width);
// All lanes: emits SetMasterTarget and EndDrag.
void masterSlider(const Ui& ui, const PanelInput& input, const WindowState& state, float width);

// The master's value as text.
std::string masterText(const Document& document);

// The error in pixels at this view that asks for what the lane shows now.
double shownPixels(const Document& document, const Lane& lane);

// The target that asks for what the lane shows now, in another kind.
Target sameTarget(const Lane& lane, Target::Kind kind);

} // namespace lodestone::ui
