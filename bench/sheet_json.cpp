#include "bench/sheet_json.h"

#include <limits>

namespace lodestone::bench {

namespace {

using Json = nlohmann::json;

// Null is what became of NaN.
double number(const Json& json) {
    return json.is_null() ? std::numeric_limits<double>::quiet_NaN() : json.get<double>();
}

Json spreadJson(const Spread& spread) {
    return {spread.median, spread.min, spread.max};
}

Spread spreadFrom(const Json& json) {
    return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

Json worthJson(const Worth& worth) {
    return {{"triangles", worth.triangles},
            {"instances", worth.instances},
            {"bytes", worth.bytes},
            {"predicted_bytes", worth.predicted_bytes},
            {"maximum", worth.maximum},
            {"mean", worth.mean},
            {"flip", worth.flip}};
}

Worth worthFrom(const Json& json) {
    Worth worth;
    worth.triangles = json.at("triangles").get<std::uint64_t>();
    worth.instances = json.at("instances").get<std::uint64_t>();
    worth.bytes = json.at("bytes").get<std::uint64_t>();
    worth.predicted_bytes = json.at("predicted_bytes").get<std::uint64_t>();
    worth.maximum = number(json.at("maximum"));
    worth.mean = number(json.at("mean"));
    worth.flip = number(json.at("flip"));
    return worth;
}

Json rowJson(const PeerRow& row) {
    return {{"name", row.name},
            {"kind", static_cast<int>(row.kind)},
            {"seconds", spreadJson(row.seconds)},
            {"time_ratio", row.time_ratio},
            {"theirs", worthJson(row.theirs)},
            {"ours", worthJson(row.ours)},
            {"failure", row.failure}};
}

PeerRow rowFrom(const Json& json) {
    PeerRow row;
    row.name = json.at("name").get<std::string>();
    row.kind = static_cast<PeerKind>(json.at("kind").get<int>());
    row.seconds = spreadFrom(json.at("seconds"));
    row.time_ratio = number(json.at("time_ratio"));
    row.theirs = worthFrom(json.at("theirs"));
    row.ours = worthFrom(json.at("ours"));
    row.failure = json.at("failure").get<std::string>();
    return row;
}

} // namespace

Json sheetJson(const PeerSheet& sheet) {
    Json rows = Json::array();
    for (const PeerRow& row : sheet.rows)
        rows.push_back(rowJson(row));
    return {{"input", sheet.input},
            {"triangles", sheet.triangles},
            {"unique_triangles", sheet.unique_triangles},
            {"instances", sheet.instances},
            {"ours_name", sheet.ours_name},
            {"our_seconds", spreadJson(sheet.our_seconds)},
            {"our_program_seconds", spreadJson(sheet.our_program_seconds)},
            {"ours", worthJson(sheet.ours)},
            {"files_of_ours", sheet.files_of_ours},
            {"files_as_predicted", sheet.files_as_predicted},
            {"rows", std::move(rows)},
            {"picture_failure", sheet.picture_failure}};
}

PeerSheet sheetOf(const Json& json) {
    PeerSheet sheet;
    sheet.input = json.at("input").get<std::string>();
    sheet.triangles = json.at("triangles").get<std::uint64_t>();
    sheet.unique_triangles = json.at("unique_triangles").get<std::uint64_t>();
    sheet.instances = json.at("instances").get<std::uint64_t>();
    sheet.ours_name = json.at("ours_name").get<std::string>();
    sheet.our_seconds = spreadFrom(json.at("our_seconds"));
    sheet.our_program_seconds = spreadFrom(json.at("our_program_seconds"));
    sheet.ours = worthFrom(json.at("ours"));
    sheet.files_of_ours = json.at("files_of_ours").get<int>();
    sheet.files_as_predicted = json.at("files_as_predicted").get<int>();
    for (const Json& row : json.at("rows"))
        sheet.rows.push_back(rowFrom(row));
    sheet.picture_failure = json.at("picture_failure").get<std::string>();
    return sheet;
}

} // namespace lodestone::bench
