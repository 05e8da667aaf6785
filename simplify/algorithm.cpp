#include "simplify/algorithm.h"

#include "simplify/ias/ias.h"
#include "simplify/pointcloud/pointcloud.h"
#include "simplify/quadric/quadric.h"
#include "simplify/wild/wild.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace lodestone {

std::span<const Algorithm> algorithms() {
    static const std::array kTable{quadricAlgorithm(),
                                   quadricSubmeshAlgorithm(),
                                   iasAlgorithm(),
                                   wildAlgorithm(),
                                   vertexTriplexAlgorithm(),
                                   faceAngleAlgorithm(),
                                   intervertexDistanceAlgorithm(),
                                   sphericalScanningAlgorithm(),
                                   vertexTriplexDistanceAlgorithm(),
                                   faceAngleScanningAlgorithm()};
    return kTable;
}

const Algorithm* findAlgorithm(std::string_view id) {
    const auto found = std::ranges::find(algorithms(), id, &Algorithm::id);
    return found == algorithms().end() ? nullptr : &*found;
}

namespace {

const ParameterInfo* findParameter(const Algorithm& algorithm, std::string_view id) {
    const auto found = std::ranges::find(algorithm.parameters, id, &ParameterInfo::id);
    return found == algorithm.parameters.end() ? nullptr : &*found;
}

std::string choicesOf(const ParameterInfo& info) {
    std::string list;
    for (const std::string_view choice : info.choices)
        list += (list.empty() ? "" : ", ") + std::string(choice);
    return list;
}

std::string shortNumber(double value) {
    std::array<char, 32> text;
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

} // namespace

double
parameterValue(const Algorithm& algorithm, const ParameterValues& values, std::string_view id) {
    const auto given = values.find(id);
    if (given != values.end())
        return given->second;
    const ParameterInfo* info = findParameter(algorithm, id);
    return info ? info->fallback : 0.0;
}

Result<void> checkParameters(const Algorithm& algorithm, const ParameterValues& values) {
    for (const auto& entry : values) {
        const std::string& id = entry.first;
        const auto same = [&](const ParameterInfo& info) { return info.id == id; };
        const auto found = std::ranges::find_if(algorithm.parameters, same);
        if (found == algorithm.parameters.end())
            return fail(ErrorKind::Usage,
                        std::string(algorithm.id) + ": unknown parameter '" + id + "'");
        const double maximum = found->kind == ParameterInfo::Kind::Choice
                                   ? static_cast<double>(found->choices.size() - 1)
                                   : found->maximum;
        if (!(entry.second >= found->minimum && entry.second <= maximum))
            return fail(ErrorKind::Usage,
                        std::string(algorithm.id) + ": parameter '" + id + "' is out of range");
    }
    return {};
}

Result<double>
parseParameter(const Algorithm& algorithm, std::string_view id, std::string_view text) {
    const ParameterInfo* info = findParameter(algorithm, id);
    const std::string where = std::string(algorithm.id) + ": parameter '" + std::string(id) + "'";
    if (!info)
        return fail(ErrorKind::Usage, where + " is unknown: see --list-algorithms");
    if (info->kind == ParameterInfo::Kind::Choice) {
        const auto found = std::ranges::find(info->choices, text);
        if (found == info->choices.end())
            return fail(ErrorKind::Usage, where + " takes one of: " + choicesOf(*info));
        return static_cast<double>(found - info->choices.begin());
    }
    if (info->kind == ParameterInfo::Kind::Toggle) {
        if (text == "1" || text == "on" || text == "true")
            return 1.0;
        if (text == "0" || text == "off" || text == "false")
            return 0.0;
        return fail(ErrorKind::Usage, where + " takes on or off");
    }
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool whole = info->kind != ParameterInfo::Kind::Integer || value == std::floor(value);
    if (error != std::errc{} || end != text.data() + text.size() || !whole ||
        !(value >= info->minimum && value <= info->maximum))
        return fail(ErrorKind::Usage,
                    where + " takes a number from " + shortNumber(info->minimum) + " to " +
                        shortNumber(info->maximum));
    return value;
}

} // namespace lodestone
