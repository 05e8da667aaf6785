#include "app/cli_report.h"
#include "app/report/html_sections.h"
#include "app/report/html_table.h"
#include "app/report/html_text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/core.h>
#include <functional>

namespace lodestone {

namespace {

std::optional<double> distanceOf(const ComparisonRow& row, double Distance::*member) {
    return row.outcome.distance ? std::optional((*row.outcome.distance).*member) : std::nullopt;
}

std::optional<double> imageOf(const ComparisonRow& row, double ImageDifference::*member) {
    return row.image ? std::optional((*row.image).*member) : std::nullopt;
}

double buildSeconds(const ComparisonRow& row) {
    const StageSeconds& seconds = row.outcome.seconds;
    return seconds.sequence + seconds.schedule + seconds.readout;
}

std::string countText(double value) {
    return thousands(static_cast<std::uint64_t>(value));
}

std::string bytesText(double value) {
    return humanBytes(static_cast<std::uint64_t>(value));
}

// As many decimals in all of the column as its smallest value needs.
std::function<std::string(double)>
alignedDecimals(const Comparison& comparison,
                const std::function<std::optional<double>(const ComparisonRow&)>& value) {
    double smallest = 0.0;
    for (const ComparisonRow& row : comparison.rows) {
        const std::optional<double> one = row.failed() ? std::nullopt : value(row);
        if (one && *one > 0.0 && (smallest == 0.0 || *one < smallest))
            smallest = *one;
    }
    const int decimals = std::max(decimalsFor(smallest), 2);
    return [decimals](double number) { return fixedText(number, decimals); };
}

std::vector<Part> byteParts(const ComparisonRow& row) {
    const ByteParts& parts = row.parts;
    std::vector<Part> list = {{"Geometry", static_cast<double>(parts.geometry), {}},
                              {"Instances", static_cast<double>(parts.instances), {}},
                              {"Materials, images", static_cast<double>(parts.materials), {}},
                              {"JSON", static_cast<double>(parts.json), {}},
                              {"Other", static_cast<double>(parts.other), {}}};
    for (Part& part : list)
        part.text = bytesText(part.value);
    return list;
}

std::vector<Part> timeParts(const ComparisonRow& row) {
    const StageSeconds& seconds = row.outcome.seconds;
    std::vector<Part> list = {{"Sequence", seconds.sequence, {}},
                              {"Schedule", seconds.schedule, {}},
                              {"Read-out", seconds.readout, {}},
                              {"Write", seconds.write, {}}};
    for (Part& part : list)
        part.text = secondsText(part.value);
    return list;
}

double sumOf(const std::vector<Part>& parts) {
    double sum = 0.0;
    for (const Part& part : parts)
        sum += part.value;
    return sum;
}

double longestOf(const Comparison& comparison,
                 std::vector<Part> (*parts_of)(const ComparisonRow&)) {
    double longest = 0.0;
    for (const ComparisonRow* row : shownRows(comparison))
        longest = std::max(longest, sumOf(parts_of(*row)));
    return longest;
}

Table resultTable(const Comparison& comparison) {
    const double all_bytes = static_cast<double>(comparison.original.outcome.bytes);
    const auto distance = [](double Distance::*member) {
        return [member](const ComparisonRow& row) { return distanceOf(row, member); };
    };
    const auto image = [](double ImageDifference::*member) {
        return [member](const ComparisonRow& row) { return imageOf(row, member); };
    };
    const auto bytes = [](const ComparisonRow& row) {
        return static_cast<double>(row.outcome.bytes);
    };
    const auto lod = [](std::uint64_t Lod::*member) {
        return [member](const ComparisonRow& row) {
            return std::optional(static_cast<double>((*row.outcome.lod).*member));
        };
    };
    const auto hausdorff = distance(&Distance::hausdorff);
    const auto mean = distance(&Distance::mean);
    const auto rms = distance(&Distance::rms);
    Table table{"results", "Results", "", {}, "", {}};
    table.columns = {
        {"Triangles", "every instance counted", lod(&Lod::triangles), countText},
        {"%",
         "of the original’s triangles",
         [&](const ComparisonRow& row) { return 100.0 * shareOf(comparison, row); },
         [](double value) { return fixedText(value, 1); }},
        {"Unique", "triangles stored, every submesh once", lod(&Lod::unique_triangles), countText},
        {"Instances", "kept", lod(&Lod::instances), countText},
        {"File", "of the written GLB", bytes, bytesText, Better::Less},
        {"× original",
         "file size over that of the original, written alike",
         [=](const ComparisonRow& row) { return bytes(row) / std::max(all_bytes, 1.0); },
         [](double value) { return fixedText(value, 2); },
         Better::Less},
        {"Hausdorff %",
         "largest distance, % of the diagonal",
         hausdorff,
         alignedDecimals(comparison, hausdorff),
         Better::Less},
        {"Mean %",
         "mean distance, % of the diagonal",
         mean,
         alignedDecimals(comparison, mean),
         Better::Less},
        {"RMS %",
         "root mean square distance, % of the diagonal",
         rms,
         alignedDecimals(comparison, rms),
         Better::Less},
        {"FLIP",
         "image difference over twelve cameras: 0 equal, 1 most",
         image(&ImageDifference::flip),
         [](double value) { return fixedText(value, 4); },
         Better::Less},
        {"SSIM",
         "structural similarity over twelve cameras: 1 equal",
         image(&ImageDifference::ssim),
         [](double value) { return fixedText(value, 3); },
         Better::More},
        {"PSNR dB",
         "peak signal-to-noise ratio over twelve cameras",
         image(&ImageDifference::psnr_db),
         [](double value) { return std::isfinite(value) ? fixedText(value, 1) : "equal"; },
         Better::More},
        {"Built in",
         "sequence, schedule and read-out",
         [](const ComparisonRow& row) {
             return row.algorithm ? std::optional(buildSeconds(row)) : std::nullopt;
         },
         secondsText,
         Better::Less}};
    return table;
}

Table bytesTable(const Comparison& comparison) {
    const auto part = [](std::uint64_t ByteParts::*member) {
        return [member](const ComparisonRow& row) {
            return std::optional(static_cast<double>(row.parts.*member));
        };
    };
    const double longest = longestOf(comparison, byteParts);
    Table table{"bytes", "What the file is made of", "", {}, "Share", {}};
    table.bar = [longest](const ComparisonRow& row) { return stackedBar(byteParts(row), longest); };
    table.columns = {
        {"<i class=\"part-1\"></i>Geometry",
         "vertices and indices",
         part(&ByteParts::geometry),
         countText},
        {"<i class=\"part-2\"></i>Instances",
         "nodes and rows of EXT_mesh_gpu_instancing",
         part(&ByteParts::instances),
         countText},
        {"<i class=\"part-3\"></i>Materials, images",
         "materials, textures, images",
         part(&ByteParts::materials),
         countText},
        {"<i class=\"part-4\"></i>JSON",
         "headers, accessors and the rest of the JSON",
         part(&ByteParts::json),
         countText},
        {"<i class=\"part-5\"></i>Other",
         "animations, skins, padding",
         part(&ByteParts::other),
         countText},
        {"Written",
         "bytes of the GLB file",
         [](const ComparisonRow& row) { return static_cast<double>(row.outcome.bytes); },
         countText},
        {"Predicted",
         "bytes told before writing",
         [](const ComparisonRow& row) { return static_cast<double>(row.outcome.predicted_bytes); },
         countText},
        {"Equal",
         "whether the prediction holds to the byte",
         [](const ComparisonRow& row) {
             return row.outcome.bytes == row.outcome.predicted_bytes ? 1.0 : 0.0;
         },
         [](double equal) {
             return std::string(equal == 1.0 ? "<span class=\"good\">✓</span>"
                                             : "<span class=\"warning\">✗</span>");
         }}};
    return table;
}

Table timeTable(const Comparison& comparison) {
    const auto stage = [](double StageSeconds::*member) {
        return [member](const ComparisonRow& row) {
            return row.algorithm ? std::optional(row.outcome.seconds.*member) : std::nullopt;
        };
    };
    const auto always = [](double StageSeconds::*member) {
        return [member](const ComparisonRow& row) {
            return std::optional(row.outcome.seconds.*member);
        };
    };
    const double longest = longestOf(comparison, timeParts);
    Table table{"times", "Time by stage", "", {}, "Share", {}};
    table.bar = [longest](const ComparisonRow& row) { return stackedBar(timeParts(row), longest); };
    table.columns = {
        {"<i class=\"part-1\"></i>Sequence",
         "building what every level is read from",
         stage(&StageSeconds::sequence),
         secondsText},
        {"<i class=\"part-2\"></i>Schedule",
         "ordering the steps of all submeshes",
         stage(&StageSeconds::schedule),
         secondsText},
        {"<i class=\"part-3\"></i>Read-out",
         "from the target to meshes",
         stage(&StageSeconds::readout),
         secondsText},
        {"<i class=\"part-4\"></i>Write",
         "the GLB file",
         always(&StageSeconds::write),
         secondsText},
        {"Total",
         "sequence to write",
         [](const ComparisonRow& row) { return sumOf(timeParts(row)); },
         secondsText,
         Better::Less},
        {"Load", "the source file, once for all", always(&StageSeconds::load), secondsText}};
    return table;
}

} // namespace

std::string tablesSection(const Comparison& comparison) {
    return tableSection(comparison, resultTable(comparison)) +
           tableSection(comparison, bytesTable(comparison)) +
           tableSection(comparison, timeTable(comparison));
}

} // namespace lodestone
