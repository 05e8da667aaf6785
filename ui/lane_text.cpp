#include "ui/lane_text.h"

#include <cstdio>

namespace lodestone::ui {

namespace {

// "boundary 2" for every parameter that is not at its default.
std::string changedParameters(const LaneSettings& settings) {
    std::string text;
    for (const ParameterInfo& parameter : settings.algorithm->parameters) {
        const double value = parameterValue(*settings.algorithm, settings.parameters, parameter.id);
        const bool counts =
            parameter.needs.empty() ||
            parameterValue(*settings.algorithm, settings.parameters, parameter.needs) != 0.0;
        if (value == parameter.fallback || !counts)
            continue;
        char number[32] = "";
        std::snprintf(number, sizeof number, "%.3g", value);
        text += text.empty() ? "" : ", ";
        text += std::string(parameter.label) + " ";
        const auto choice = static_cast<std::size_t>(value);
        if (parameter.kind == ParameterInfo::Kind::Choice && choice < parameter.choices.size())
            text += parameter.choices[choice];
        else if (parameter.kind == ParameterInfo::Kind::Toggle)
            text += value != 0.0 ? "on" : "off";
        else
            text += number;
    }
    return text;
}

} // namespace

std::string_view orderingName(Ordering ordering) {
    switch (ordering) {
    case Ordering::Triangle:
        return "triangle";
    case Ordering::Byte:
        return "byte";
    case Ordering::Cost:
        return "cost";
    }
    return {};
}

std::string sceneTitle(const Document& document) {
    if (!document.path.empty())
        return document.path.filename().string();
    return document.scene ? document.scene->name : std::string();
}

std::string laneSummary(const Document& document, const Lane& lane) {
    const LaneSettings& settings = lane.settings;
    if (!settings.algorithm)
        return sceneTitle(document);
    std::string text;
    if (settings.algorithm->expands)
        text = "expanded";
    else if (settings.algorithm->family == Family::EdgeCollapse)
        text = "per " + std::string(orderingName(settings.ordering));
    const std::string changed = changedParameters(settings);
    if (!changed.empty())
        text += (text.empty() ? "" : " \u00b7 ") + changed;
    return text;
}

std::string_view instancingName(Instancing instancing) {
    switch (instancing) {
    case Instancing::Auto:
        return "smallest";
    case Instancing::Nodes:
        return "nodes";
    case Instancing::Gpu:
        return "GPU instancing";
    case Instancing::Expand:
        return "expanded";
    }
    return {};
}

double frameMilliseconds(const Lane& lane) {
    return lane.status.rate ? lane.status.rate->mean_ms : lane.status.frame_ms;
}

double framesPerSecond(const Lane& lane) {
    const double time_ms = frameMilliseconds(lane);
    return time_ms > 0.0 ? 1000.0 / time_ms : 0.0;
}

} // namespace lodestone::ui
