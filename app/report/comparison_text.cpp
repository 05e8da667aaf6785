#include "app/report/comparison_text.h"

#include "app/cli_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace lodestone {

namespace {

using Json = nlohmann::ordered_json;
using Cells = std::vector<std::string>;

constexpr std::string_view kMissing = "-";

Cells tableCells(const ComparisonRow& row, std::uint64_t all_triangles) {
    const RunOutcome& outcome = row.outcome;
    const double share = 100.0 * static_cast<double>(outcome.lod->triangles) /
                         static_cast<double>(std::max<std::uint64_t>(all_triangles, 1));
    Cells cells = {std::string(rowId(row)),
                   thousands(outcome.lod->triangles),
                   fmt::format("{:.2f}", share),
                   thousands(outcome.lod->unique_triangles),
                   thousands(outcome.lod->instances),
                   humanBytes(outcome.bytes),
                   outcome.bytes == outcome.predicted_bytes ? "exact" : "WRONG"};
    const bool measured = outcome.distance.has_value();
    cells.push_back(measured ? fmt::format("{:.4f}", outcome.distance->hausdorff) : "-");
    cells.push_back(measured ? fmt::format("{:.5f}", outcome.distance->mean) : "-");
    cells.push_back(row.image ? fmt::format("{:.4f}", row.image->flip) : "-");
    cells.push_back(row.algorithm
                        ? fmt::format("{:.2f}", outcome.seconds.sequence + outcome.seconds.schedule)
                        : "-");
    return cells;
}

// First column to the left, numbers to the right; two spaces between.
std::string aligned(const std::vector<Cells>& lines) {
    std::vector<std::size_t> widths(lines.front().size(), 0);
    for (const Cells& cells : lines)
        for (std::size_t i = 0; i < cells.size(); ++i)
            widths[i] = std::max(widths[i], cells[i].size());
    std::string text;
    for (const Cells& cells : lines) {
        std::string line = fmt::format("{:<{}}", cells.front(), widths.front());
        for (std::size_t i = 1; i < cells.size(); ++i)
            line += fmt::format("  {:>{}}", cells[i], widths[i]);
        text += line + "\n";
    }
    return text;
}

std::string remarkLines(const Comparison& comparison, const ComparisonRow& row) {
    std::string text;
    const std::string deviation = deviationText(comparison, row);
    if (row.failed())
        text += fmt::format("failed: {}: {}\n", rowId(row), row.failure);
    if (!deviation.empty())
        text += fmt::format("note: {}: {}\n", rowId(row), deviation);
    for (const std::string& note : row.outcome.notes)
        text += fmt::format("note: {}: {}\n", rowId(row), note);
    return text;
}

Json finiteOrNull(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json rowObject(const ComparisonRow& row) {
    if (row.failed())
        return {{"algorithm", rowId(row)}, {"failure", row.failure}};
    Json json = outcomeObject(row.outcome);
    json["target_met"] = row.outcome.target_met;
    json["bytes_by_part"] = {{"geometry", row.parts.geometry},
                             {"instances", row.parts.instances},
                             {"materials", row.parts.materials},
                             {"json", row.parts.json},
                             {"other", row.parts.other}};
    if (row.image)
        json["image"] = {{"flip", row.image->flip},
                         {"ssim", row.image->ssim},
                         {"psnr_db", finiteOrNull(row.image->psnr_db)},
                         {"cameras", row.image->cameras}};
    return json;
}

// Quoted where it must be (RFC 4180).
std::string csvField(std::string_view text) {
    if (text.find_first_of(",\"\r\n") == std::string_view::npos)
        return std::string(text);
    std::string quoted = "\"";
    for (const char letter : text) {
        if (letter == '"')
            quoted += '"';
        quoted += letter;
    }
    return quoted + '"';
}

std::string csvNumber(double value) {
    return std::isfinite(value) ? fmt::format("{:.9g}", value) : std::string();
}

constexpr std::array kCsvColumns = {"algorithm",
                                    "triangles",
                                    "unique_triangles",
                                    "instances",
                                    "bytes",
                                    "predicted_bytes",
                                    "bytes_geometry",
                                    "bytes_instances",
                                    "bytes_materials",
                                    "bytes_json",
                                    "bytes_other",
                                    "seconds_load",
                                    "seconds_sequence",
                                    "seconds_schedule",
                                    "seconds_readout",
                                    "seconds_write",
                                    "hausdorff",
                                    "mean",
                                    "rms",
                                    "flip",
                                    "ssim",
                                    "psnr_db",
                                    "target_met",
                                    "notes"};

Cells csvCells(const ComparisonRow& row) {
    Cells cells(kCsvColumns.size());
    cells.front() = rowId(row);
    if (row.failed()) {
        cells.back() = "failed: " + row.failure;
        return cells;
    }
    const RunOutcome& outcome = row.outcome;
    std::size_t next = 1;
    for (const std::uint64_t count : {outcome.lod->triangles,
                                      outcome.lod->unique_triangles,
                                      outcome.lod->instances,
                                      outcome.bytes,
                                      outcome.predicted_bytes,
                                      row.parts.geometry,
                                      row.parts.instances,
                                      row.parts.materials,
                                      row.parts.json,
                                      row.parts.other})
        cells[next++] = std::to_string(count);
    const StageSeconds& seconds = outcome.seconds;
    for (const double value :
         {seconds.load, seconds.sequence, seconds.schedule, seconds.readout, seconds.write})
        cells[next++] = fmt::format("{:.6f}", value);
    const Distance distance = outcome.distance.value_or(Distance{});
    for (const double value : {distance.hausdorff, distance.mean, distance.rms})
        cells[next++] = outcome.distance ? csvNumber(value) : std::string();
    const ImageDifference image = row.image.value_or(ImageDifference{});
    for (const double value : {image.flip, image.ssim, image.psnr_db})
        cells[next++] = row.image ? csvNumber(value) : std::string();
    cells[next++] = outcome.target_met ? "true" : "false";
    for (const std::string& note : outcome.notes)
        cells[next] += (cells[next].empty() ? "" : "; ") + note;
    return cells;
}

std::string csvLine(const Cells& cells) {
    std::string line;
    for (const std::string& cell : cells)
        line += (&cell == cells.data() ? "" : ",") + csvField(cell);
    return line + "\n";
}

} // namespace

std::string_view rowId(const ComparisonRow& row) {
    return row.algorithm ? row.algorithm->id : std::string_view("original");
}

std::string targetText(const Target& target) {
    const auto count = [&] { return thousands(static_cast<std::uint64_t>(target.value)); };
    switch (target.kind) {
    case Target::Kind::Ratio:
        return fmt::format("{:g} % of the triangles", 100.0 * target.value);
    case Target::Kind::Triangles:
        return fmt::format("at most {} triangles", count());
    case Target::Kind::Bytes:
        return fmt::format("at most {} bytes", count());
    case Target::Kind::Error:
        break;
    }
    return fmt::format("an error of {:g} % of the diagonal", target.value);
}

std::string deviationText(const Comparison& comparison, const ComparisonRow& row) {
    constexpr double kNear = 0.01;
    const std::optional<double> deviation = targetDeviation(comparison, row);
    if (!deviation || !row.algorithm || std::abs(*deviation) <= kNear)
        return {};
    const double percent = 100.0 * std::abs(*deviation);
    const std::string size =
        percent < 10.0 ? fmt::format("{:.1f}", percent) : fmt::format("{:.0f}", percent);
    return *deviation > 0.0 ? fmt::format("the target is missed: {} % above", size)
                            : fmt::format("{} % below the target", size);
}

std::string comparisonTable(const Comparison& comparison) {
    const std::uint64_t all_triangles = comparison.original.outcome.lod->triangles;
    std::vector<Cells> lines = {{"algorithm",
                                 "triangles",
                                 "%",
                                 "unique",
                                 "instances",
                                 "size",
                                 "predicted",
                                 "Hausdorff %",
                                 "mean %",
                                 "FLIP",
                                 "build s"}};
    lines.push_back(tableCells(comparison.original, all_triangles));
    for (const ComparisonRow& row : comparison.rows) {
        if (row.failed()) {
            lines.emplace_back(lines.front().size(), std::string(kMissing));
            lines.back().front() = rowId(row);
        } else {
            lines.push_back(tableCells(row, all_triangles));
        }
    }
    std::string text = aligned(lines);
    for (const ComparisonRow& row : comparison.rows)
        text += remarkLines(comparison, row);
    if (!comparison.pictures_missing.empty())
        text += fmt::format("note: no image difference: {}\n", comparison.pictures_missing);
    return text;
}

std::string comparisonJson(const Comparison& comparison) {
    Json json;
    json["original"] = rowObject(comparison.original);
    json["rows"] = Json::array();
    for (const ComparisonRow& row : comparison.rows)
        json["rows"].push_back(rowObject(row));
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string comparisonCsv(const Comparison& comparison) {
    std::string text = csvLine(Cells(kCsvColumns.begin(), kCsvColumns.end()));
    text += csvLine(csvCells(comparison.original));
    for (const ComparisonRow& row : comparison.rows)
        text += csvLine(csvCells(row));
    return text;
}

} // namespace lodestone
