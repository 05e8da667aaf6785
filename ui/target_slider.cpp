#include "ui/target_slider.h"

#include "ui/widgets.h"

#include <algorithm>

namespace lodestone::ui {

namespace {

constexpr std::string_view kTargetTip =
    "How much of the scene this lane keeps. Click on the value to type one.";
constexpr std::string_view kMasterTip =
    "How much of the scene every lane keeps that follows all lanes.";

SliderSpec specOf(const TargetScale& scale, const Target& target, std::string_view label) {
    SliderSpec spec;
    spec.label = label;
    spec.value = formatTarget(target);
    spec.edit_text = editableTarget(target);
    spec.fraction = fractionOf(scale, target.value);
    spec.tooltip = kTargetTip;
    return spec;
}

std::optional<double> newValue(const TargetScale& scale, const SliderEvent& event) {
    if (event.typed)
        return parseTarget(scale, *event.typed);
    if (event.fraction)
        return valueAt(scale, *event.fraction);
    return std::nullopt;
}

} // namespace

std::uint64_t largestBytes(const PanelInput& input, const WindowState& state) {
    std::uint64_t largest = 0;
    for (const Lane& lane : input.document.lanes) {
        largest = std::max(largest, lane.status.numbers.kept_bytes);
        const SizeCurve& curve = state.curves.of(lane.id);
        if (!curve.empty())
            largest = std::max(largest, static_cast<std::uint64_t>(curve.back().size_bytes));
    }
    return largest;
}

Target sameTarget(const Lane& lane, Target::Kind kind) {
    const LaneNumbers& numbers = lane.status.numbers;
    switch (kind) {
    case Target::Kind::Ratio:
        return {kind, std::clamp(numbers.ratio, 1e-4, 1.0)};
    case Target::Kind::Triangles:
        return {kind, static_cast<double>(std::max<std::uint64_t>(1, numbers.triangles))};
    case Target::Kind::Bytes:
        return {kind, static_cast<double>(std::max<std::uint64_t>(1, numbers.kept_bytes))};
    case Target::Kind::Error:
        return {kind, std::max(1e-4, numbers.error_estimate)};
    }
    return {};
}

std::string masterText(const Document& document) {
    return document.master_px ? formatPixels(*document.master_px) : formatTarget(document.master);
}

double shownPixels(const Document& document, const Lane& lane) {
    const double one_pixel = errorOfPixels(document, 1.0);
    const double wanted = one_pixel > 0.0 ? lane.status.numbers.error_estimate / one_pixel : 1.0;
    const TargetScale scale = pixelScale();
    return std::clamp(wanted, scale.smallest, scale.full);
}

namespace {

SliderSpec pixelSpec(double pixels, std::string_view label) {
    SliderSpec spec;
    spec.label = label;
    spec.value = formatPixels(pixels);
    spec.edit_text = formatPixels(pixels);
    spec.fraction = fractionOf(pixelScale(), pixels);
    spec.tooltip = "How far the surface may be off in this view, in pixels. It follows the camera.";
    return spec;
}

} // namespace

void laneTargetSlider(const Ui& ui,
                      const PanelInput& input,
                      const WindowState& state,
                      const Lane& lane,
                      float width) {
    const Target& target = lane.settings.target;
    const std::optional<double>& pixels = lane.settings.error_px;
    const TargetScale scale =
        pixels ? pixelScale()
               : targetScale(input.document, target.kind, largestBytes(input, state));
    SliderSpec spec = pixels ? pixelSpec(*pixels, "Target") : specOf(scale, target, "Target");
    spec.colour = packed(lane.settings.colour);
    spec.enabled = lane.settings.algorithm != nullptr;
    if (!spec.enabled)
        spec.fraction = 1.0;
    const SliderEvent event = width > 0 ? sliderTrack(ui, spec, width) : slider(ui, spec);
    if (const std::optional<double> value = newValue(scale, event)) {
        if (pixels)
            ui.push(SetLanePixels{lane.id, *value, event.drag});
        else
            ui.push(SetLaneTarget{lane.id, {target.kind, *value}, event.drag});
    }
    if (event.released || event.typed)
        ui.push(EndDrag{});
}

void masterSlider(const Ui& ui, const PanelInput& input, const WindowState& state, float width) {
    const Target& target = input.document.master;
    const std::optional<double>& pixels = input.document.master_px;
    const TargetScale scale =
        pixels ? pixelScale()
               : targetScale(input.document, target.kind, largestBytes(input, state));
    SliderSpec spec = pixels ? pixelSpec(*pixels, "Master") : specOf(scale, target, "Master");
    if (!pixels)
        spec.tooltip = kMasterTip;
    const SliderEvent event = sliderTrack(ui, spec, width);
    if (const std::optional<double> value = newValue(scale, event)) {
        if (pixels)
            ui.push(SetMasterPixels{*value, event.drag});
        else
            ui.push(SetMasterTarget{{target.kind, *value}, event.drag});
    }
    if (event.released)
        ui.push(EndDrag{});
}

} // namespace lodestone::ui
