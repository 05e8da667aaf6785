#include "ui/parameter_control.h"

#include "ui/widgets.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace lodestone::ui {

namespace {

double parameterFraction(const ParameterInfo& parameter, double value) {
    const double low = parameter.minimum;
    const double high = parameter.maximum;
    if (!(high > low))
        return 0.0;
    if (parameter.logarithmic && low > 0.0)
        return std::log(std::max(value, low) / low) / std::log(high / low);
    return (value - low) / (high - low);
}

double parameterAt(const ParameterInfo& parameter, double fraction) {
    const double low = parameter.minimum;
    const double high = parameter.maximum;
    const double value = parameter.logarithmic && low > 0.0 ? low * std::pow(high / low, fraction)
                                                            : low + (high - low) * fraction;
    return parameter.kind == ParameterInfo::Kind::Integer ? std::round(value) : value;
}

std::string parameterText(const ParameterInfo& parameter, double value) {
    char number[32] = "";
    std::snprintf(number,
                  sizeof number,
                  parameter.kind == ParameterInfo::Kind::Integer ? "%.0f" : "%.3g",
                  value);
    return parameter.unit.empty() ? number
                                  : std::string(number) + " " + std::string(parameter.unit);
}

void parameterSlider(const Ui& ui, const Lane& lane, const ParameterInfo& parameter, double value) {
    SliderSpec spec;
    spec.label = parameter.label;
    spec.value = parameterText(parameter, value);
    char number[32] = "";
    std::snprintf(number, sizeof number, "%.6g", value);
    spec.edit_text = number;
    spec.fraction = parameterFraction(parameter, value);
    spec.tooltip = parameter.tooltip;
    const SliderEvent event = slider(ui, spec);
    std::optional<double> wanted;
    if (event.fraction)
        wanted = parameterAt(parameter, *event.fraction);
    if (event.typed)
        wanted = std::strtod(event.typed->c_str(), nullptr);
    if (wanted && std::isfinite(*wanted))
        ui.push(SetLaneParameter{lane.id, std::string(parameter.id), *wanted, event.drag});
    if (event.released || event.typed)
        ui.push(EndDrag{});
}

} // namespace

void parameterControl(const Ui& ui, const Lane& lane, const ParameterInfo& parameter) {
    const LaneSettings& settings = lane.settings;
    if (!parameter.needs.empty() &&
        parameterValue(*settings.algorithm, settings.parameters, parameter.needs) == 0.0)
        return;
    const double value = parameterValue(*settings.algorithm, settings.parameters, parameter.id);
    switch (parameter.kind) {
    case ParameterInfo::Kind::Number:
    case ParameterInfo::Kind::Integer:
        parameterSlider(ui, lane, parameter, value);
        break;
    case ParameterInfo::Kind::Toggle: {
        bool on = value != 0.0;
        if (toggle(ui, parameter.label, on))
            ui.push(SetLaneParameter{lane.id, std::string(parameter.id), on ? 1.0 : 0.0});
        tooltip(ui, parameter.tooltip);
        break;
    }
    case ParameterInfo::Kind::Choice: {
        const ImVec2 begin = ImGui::GetCursorScreenPos();
        drawText(ui, begin, Align::Left, parameter.label, {nullptr, color::kSecondary});
        ImGui::Dummy({ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight()});
        tooltip(ui, parameter.tooltip);
        const std::vector<std::string> names(parameter.choices.begin(), parameter.choices.end());
        if (const auto chosen = combo(ui, parameter.label, names, static_cast<int>(value)))
            ui.push(
                SetLaneParameter{lane.id, std::string(parameter.id), static_cast<double>(*chosen)});
        break;
    }
    }
}

} // namespace lodestone::ui
