#include "app/cli_report.h"

#include <algorithm>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace lodestone {

namespace {

using Json = nlohmann::ordered_json;

std::string dump(const Json& json) {
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string_view kindName(ParameterInfo::Kind kind) {
    switch (kind) {
    case ParameterInfo::Kind::Number:
        return "number";
    case ParameterInfo::Kind::Integer:
        return "integer";
    case ParameterInfo::Kind::Toggle:
        return "toggle";
    case ParameterInfo::Kind::Choice:
        return "choice";
    }
    return "number";
}

std::string choiceName(const ParameterInfo& info, std::size_t index) {
    return index < info.choices.size() ? std::string(info.choices[index]) : std::to_string(index);
}

std::string rangeText(const ParameterInfo& info) {
    switch (info.kind) {
    case ParameterInfo::Kind::Toggle:
        return fmt::format("on|off, default {}", info.fallback != 0.0 ? "on" : "off");
    case ParameterInfo::Kind::Choice: {
        std::string text;
        for (std::size_t index = 0; index < info.choices.size(); ++index)
            text += (index == 0 ? "" : "|") + choiceName(info, index);
        return fmt::format(
            "{}, default {}", text, choiceName(info, static_cast<std::size_t>(info.fallback)));
    }
    case ParameterInfo::Kind::Number:
    case ParameterInfo::Kind::Integer:
        break;
    }
    const std::string_view space = info.unit.empty() ? "" : " ";
    return fmt::format("{:g}..{:g}{}{}, default {:g}",
                       info.minimum,
                       info.maximum,
                       space,
                       info.unit,
                       info.fallback);
}

Json parameterObject(const ParameterInfo& info) {
    Json json;
    json["id"] = info.id;
    json["label"] = info.label;
    json["kind"] = kindName(info.kind);
    json["unit"] = info.unit;
    json["minimum"] = info.minimum;
    json["maximum"] = info.maximum;
    json["default"] = info.fallback;
    if (info.kind == ParameterInfo::Kind::Choice)
        json["choices"] = info.choices;
    json["tooltip"] = info.tooltip;
    return json;
}

} // namespace

std::string thousands(std::uint64_t value) {
    std::string digits = std::to_string(value);
    for (std::size_t place = digits.size(); place > 3; place -= 3)
        digits.insert(place - 3, ",");
    return digits;
}

std::string humanBytes(std::uint64_t bytes) {
    const auto value = static_cast<double>(bytes);
    if (value >= 1e9)
        return fmt::format("{:.2f} GB", value / 1e9);
    if (value >= 1e6)
        return fmt::format("{:.2f} MB", value / 1e6);
    if (value >= 1e3)
        return fmt::format("{:.1f} KB", value / 1e3);
    return fmt::format("{} B", bytes);
}

nlohmann::ordered_json outcomeObject(const RunOutcome& outcome) {
    Json json;
    json["algorithm"] = outcome.algorithm;
    json["triangles"] = outcome.lod->triangles;
    json["unique_triangles"] = outcome.lod->unique_triangles;
    json["instances"] = outcome.lod->instances;
    json["bytes"] = outcome.bytes;
    json["predicted_bytes"] = outcome.predicted_bytes;
    const StageSeconds& seconds = outcome.seconds;
    json["seconds"] = {{"load", seconds.load},
                       {"sequence", seconds.sequence},
                       {"schedule", seconds.schedule},
                       {"readout", seconds.readout},
                       {"write", seconds.write}};
    if (outcome.distance)
        json["error"] = {{"hausdorff", outcome.distance->hausdorff},
                         {"mean", outcome.distance->mean},
                         {"rms", outcome.distance->rms}};
    json["notes"] = outcome.notes;
    return json;
}

std::string outcomeJson(const RunOutcome& outcome) {
    return dump(outcomeObject(outcome));
}

std::string outcomeText(const RunOutcome& outcome, const SceneCounts& before) {
    std::string text =
        fmt::format("{}: {} of {} triangles ({:.2f} %), {} unique, {} of {} "
                    "instances, {}\n",
                    outcome.name,
                    thousands(outcome.lod->triangles),
                    thousands(before.triangles),
                    100.0 * static_cast<double>(outcome.lod->triangles) /
                        static_cast<double>(std::max<std::uint64_t>(before.triangles, 1)),
                    thousands(outcome.lod->unique_triangles),
                    thousands(outcome.lod->instances),
                    thousands(before.instances),
                    humanBytes(outcome.bytes));
    const StageSeconds& seconds = outcome.seconds;
    text += fmt::format("seconds: load {:.3f}, sequence {:.3f}, schedule {:.3f}, read-out {:.3f}, "
                        "write {:.3f}\n",
                        seconds.load,
                        seconds.sequence,
                        seconds.schedule,
                        seconds.readout,
                        seconds.write);
    if (outcome.distance)
        text += distanceText(*outcome.distance);
    for (const std::string& note : outcome.notes)
        text += fmt::format("note: {}\n", note);
    return text;
}

std::string distanceJson(const Distance& distance) {
    Json json;
    json["hausdorff"] = distance.hausdorff;
    json["mean"] = distance.mean;
    json["rms"] = distance.rms;
    json["samples"] = distance.samples;
    json["a_to_b"] = {{"max", distance.a_to_b_max}, {"mean", distance.a_to_b_mean}};
    json["b_to_a"] = {{"max", distance.b_to_a_max}, {"mean", distance.b_to_a_mean}};
    return dump(json);
}

std::string distanceText(const Distance& distance) {
    return fmt::format("distance in % of the diagonal: Hausdorff {:.6g}, mean {:.6g}, rms {:.6g} "
                       "({} samples)\n",
                       distance.hausdorff,
                       distance.mean,
                       distance.rms,
                       thousands(distance.samples));
}

std::string algorithmsJson() {
    Json json;
    json["algorithms"] = Json::array();
    for (const Algorithm& algorithm : algorithms()) {
        Json row;
        row["id"] = algorithm.id;
        row["name"] = algorithm.name;
        row["paper"] = algorithm.paper;
        row["summary"] = algorithm.summary;
        row["family"] = algorithm.family == Family::EdgeCollapse ? "edge-collapse" : "one-shot";
        row["expands"] = algorithm.expands;
        row["parameters"] = Json::array();
        for (const ParameterInfo& info : algorithm.parameters)
            row["parameters"].push_back(parameterObject(info));
        json["algorithms"].push_back(std::move(row));
    }
    return dump(json);
}

std::string algorithmsText() {
    std::string text;
    for (const Algorithm& algorithm : algorithms())
        text += fmt::format("{:<16} {} ({}): {}\n",
                            algorithm.id,
                            algorithm.name,
                            algorithm.paper,
                            algorithm.summary);
    return text;
}

std::string parametersText() {
    std::string text;
    for (const Algorithm& algorithm : algorithms()) {
        if (algorithm.parameters.empty())
            continue;
        text += fmt::format("Parameters of {} (--param NAME=VALUE):\n", algorithm.id);
        for (const ParameterInfo& info : algorithm.parameters)
            text += fmt::format("  {} ({})\n      {}\n", info.id, rangeText(info), info.tooltip);
    }
    return text;
}

} // namespace lodestone
