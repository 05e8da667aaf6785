#include "bench/study/study_report.h"

#include <algorithm>
#include <array>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace lodestone::bench {

namespace {

using Json = nlohmann::ordered_json;

std::string quoted(const std::string& text) {
    std::string doubled;
    for (const char c : text)
        doubled += c == '"' ? std::string("\"\"") : std::string(1, c);
    return '"' + doubled + '"';
}

Json levelJson(const StudyLevel& level) {
    return {{"triangles", level.triangles},
            {"bytes", level.bytes},
            {"hausdorff", level.hausdorff},
            {"mean", level.mean}};
}

Json countsJson(const SceneCounts& counts) {
    return {{"submeshes", counts.submeshes},
            {"instances", counts.instances},
            {"triangles", counts.triangles},
            {"unique_triangles", counts.unique_triangles}};
}

Json summaryJson(const StudySummary& summary) {
    Json json{{"models", summary.models},
              {"failed", summary.failed},
              {"mean_size_reduction", summary.mean_size_reduction},
              {"mean_size_reduction_by_cost", summary.mean_cost_size_reduction},
              {"larger_share", summary.larger_share},
              {"larger_share_by_cost", summary.cost_larger_share},
              {"mean_size_reduction_by_size", summary.mean_best_size_reduction},
              {"larger_share_by_size", summary.best_larger_share},
              {"hausdorff_kept_share_by_size", summary.best_hausdorff_kept_share},
              {"all_size_reduction", summary.all_size_reduction},
              {"larger_models", summary.larger_models},
              {"larger_that_lost_pieces", summary.larger_that_lost},
              {"hausdorff_worse_models", summary.worse_models},
              {"hausdorff_worse_that_removed", summary.worse_that_removed},
              {"hausdorff_worse_by_little", summary.worse_by_little},
              {"models_that_lost_pieces", summary.models_that_lost},
              {"pieces_lost_share", summary.pieces_lost_share},
              {"over_20_percent_smaller_share", summary.much_smaller_share},
              {"hausdorff_kept_share", summary.hausdorff_kept_share},
              {"hausdorff_no_worse_share", summary.hausdorff_no_worse_share},
              {"mean_no_worse_share", summary.mean_no_worse_share},
              {"least_triangles", summary.least_triangles},
              {"most_triangles", summary.most_triangles}};
    for (const auto& [limit, share] : summary.ips_below)
        json["ips_below"].push_back({{"limit", limit}, {"share", share}});
    return json;
}

Json tableJson(const TableRow& row) {
    Json json{{"name", row.name}};
    json.update(countsJson(row.counts));
    json["original_bytes"] = row.original_bytes;
    json["seconds"] = {{"quadric", row.quadric_seconds}, {"ias", row.ias_seconds}};
    json["time_ratio"] = row.time_ratio;
    json["quadric_bytes"] = row.quadric.bytes;
    json["ias_bytes_by_cost"] = row.by_cost.bytes;
    json["ias_bytes_by_triangle"] = row.ias.bytes;
    return json;
}

// Counts of what holds of the measured rows, as shares.
class Shares {
public:
    explicit Shares(const std::vector<const StudyRow*>& rows) : rows_(rows) {}

    template <class Holds>
    double of(const Holds& holds) const {
        const auto count =
            std::ranges::count_if(rows_, [&](const StudyRow* row) { return holds(*row); });
        return rows_.empty()
                   ? 0.0
                   : 100.0 * static_cast<double>(count) / static_cast<double>(rows_.size());
    }

private:
    const std::vector<const StudyRow*>& rows_;
};

bool keepsHausdorff(const StudyLevel& ours, const StudyLevel& theirs) {
    return ours.hausdorff <= 1.05 * theirs.hausdorff + 0.02;
}

// What goes with larger files and greater distances.
void countCauses(StudySummary& summary, const std::vector<const StudyRow*>& rows) {
    double ours = 0.0;
    double theirs = 0.0;
    double pieces = 0.0;
    double pieces_lost = 0.0;
    for (const StudyRow* row : rows) {
        ours += static_cast<double>(row->ias.bytes);
        theirs += static_cast<double>(row->quadric.bytes);
        pieces += static_cast<double>(row->pieces);
        pieces_lost += static_cast<double>(row->pieces_lost);
        summary.mean_best_size_reduction += row->bestSizeReductionPercent();
        summary.models_that_lost += row->pieces_lost > 0 ? 1 : 0;
        if (row->ias.bytes > row->quadric.bytes) {
            ++summary.larger_models;
            summary.larger_that_lost += row->pieces_lost > 0 ? 1 : 0;
        }
        if (keepsHausdorff(row->ias, row->quadric))
            continue;
        ++summary.worse_models;
        summary.worse_that_removed += row->removed > 0 ? 1 : 0;
        summary.worse_by_little += row->ias.hausdorff < 1.5 * row->quadric.hausdorff ||
                                           row->ias.hausdorff < row->quadric.hausdorff + 0.5
                                       ? 1
                                       : 0;
    }
    summary.mean_best_size_reduction /= static_cast<double>(rows.size());
    summary.all_size_reduction = theirs > 0.0 ? 100.0 * (1.0 - ours / theirs) : 0.0;
    summary.pieces_lost_share = pieces > 0.0 ? 100.0 * pieces_lost / pieces : 0.0;
}

} // namespace

StudySummary summaryOf(const Study& study) {
    StudySummary summary;
    std::vector<const StudyRow*> rows;
    for (const StudyRow& row : study.rows)
        if (row.failure.empty())
            rows.push_back(&row);
    summary.models = rows.size();
    summary.failed = study.rows.size() - rows.size();
    if (rows.empty())
        return summary;
    summary.least_triangles = ~std::uint64_t{0};
    for (const StudyRow* row : rows) {
        summary.mean_size_reduction += row->sizeReductionPercent();
        summary.mean_cost_size_reduction += row->costSizeReductionPercent();
        summary.least_triangles = std::min(summary.least_triangles, row->counts.triangles);
        summary.most_triangles = std::max(summary.most_triangles, row->counts.triangles);
    }
    summary.mean_size_reduction /= static_cast<double>(rows.size());
    summary.mean_cost_size_reduction /= static_cast<double>(rows.size());
    const Shares shares(rows);
    countCauses(summary, rows);
    summary.best_larger_share =
        shares.of([](const StudyRow& row) { return row.by_size.bytes > row.quadric.bytes; });
    summary.best_hausdorff_kept_share =
        shares.of([](const StudyRow& row) { return keepsHausdorff(row.by_size, row.quadric); });
    summary.larger_share =
        shares.of([](const StudyRow& row) { return row.ias.bytes > row.quadric.bytes; });
    summary.cost_larger_share =
        shares.of([](const StudyRow& row) { return row.by_cost.bytes > row.quadric.bytes; });
    summary.much_smaller_share =
        shares.of([](const StudyRow& row) { return row.sizeReductionPercent() > 20.0; });
    summary.hausdorff_kept_share =
        shares.of([](const StudyRow& row) { return keepsHausdorff(row.ias, row.quadric); });
    summary.hausdorff_no_worse_share =
        shares.of([](const StudyRow& row) { return row.ias.hausdorff <= row.quadric.hausdorff; });
    summary.mean_no_worse_share =
        shares.of([](const StudyRow& row) { return row.ias.mean <= row.quadric.mean; });
    for (const double limit : {1.001, 1.75, 5.0, 20.0, 100.0, 1000.0})
        summary.ips_below.emplace_back(
            limit, shares.of([&](const StudyRow& row) { return row.ips() < limit; }));
    return summary;
}

std::string studyCsv(const Study& study) {
    std::string text =
        "name,kind,submeshes,instances,ips,triangles,original_bytes,ias_triangles,ias_bytes,"
        "ias_hausdorff,ias_mean,cost_bytes,cost_hausdorff,cost_mean,quadric_triangles,"
        "quadric_bytes,quadric_hausdorff,quadric_mean,size_reduction,by_size_bytes,"
        "by_size_hausdorff,by_size_mean,instances_removed,pieces,quadric_pieces_lost,failure\n";
    for (const StudyRow& row : study.rows)
        text += fmt::format("{},{},{},{},{:.3f},{},{},{},{},{:.5g},{:.5g},{},{:.5g},{:.5g},{},{},{:"
                            ".5g},{:.5g},{:.2f},{},{:.5g},{:.5g},{},{},{},{}\n",
                            quoted(row.name),
                            row.kind,
                            row.counts.submeshes,
                            row.counts.instances,
                            row.ips(),
                            row.counts.triangles,
                            row.original_bytes,
                            row.ias.triangles,
                            row.ias.bytes,
                            row.ias.hausdorff,
                            row.ias.mean,
                            row.by_cost.bytes,
                            row.by_cost.hausdorff,
                            row.by_cost.mean,
                            row.quadric.triangles,
                            row.quadric.bytes,
                            row.quadric.hausdorff,
                            row.quadric.mean,
                            row.sizeReductionPercent(),
                            row.by_size.bytes,
                            row.by_size.hausdorff,
                            row.by_size.mean,
                            row.removed,
                            row.pieces,
                            row.pieces_lost,
                            quoted(row.failure));
    return text;
}

std::string studyJson(const Study& study) {
    Json json;
    json["summary"] = summaryJson(summaryOf(study));
    json["ratio"] = study.options.ratio;
    json["samples"] = study.options.samples;
    json["table"] = Json::array();
    for (const TableRow& row : study.table)
        json["table"].push_back(tableJson(row));
    json["tree"] = {{"original_bytes", study.tree_bytes}, {"curves", Json::array()}};
    for (const SizeCurve& curve : study.tree_curves) {
        Json levels = Json::array();
        for (const StudyLevel& level : curve.levels)
            levels.push_back({{"triangles", level.triangles}, {"bytes", level.bytes}});
        json["tree"]["curves"].push_back({{"name", curve.name}, {"levels", std::move(levels)}});
    }
    json["models"] = Json::array();
    for (const StudyRow& row : study.rows) {
        Json model{{"name", row.name}, {"kind", row.kind}, {"ips", row.ips()}};
        model.update(countsJson(row.counts));
        model["original_bytes"] = row.original_bytes;
        model["ias"] = levelJson(row.ias);
        model["ias_by_cost"] = levelJson(row.by_cost);
        model["ias_by_size"] = levelJson(row.by_size);
        model["quadric"] = levelJson(row.quadric);
        model["instances_removed"] = row.removed;
        model["quadric_pieces"] = row.pieces;
        model["quadric_pieces_lost"] = row.pieces_lost;
        model["failure"] = row.failure;
        json["models"].push_back(std::move(model));
    }
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string studyText(const Study& study) {
    const StudySummary summary = summaryOf(study);
    std::string text = fmt::format(
        "{} models ({} left out), {} to {} triangles, to {:.0f} %\n"
        "size against Quadric at equal triangles: {:.1f} % less on average (by cost {:.1f} %), "
        "larger on {:.2f} % (by cost {:.2f} %), over 20 % less on {:.1f} %\n"
        "Hausdorff at most 1.05 x Quadric's + 0.02 %: {:.1f} %; at most Quadric's: {:.1f} %; mean "
        "at most Quadric's: {:.1f} %\nIPS below:",
        summary.models,
        summary.failed,
        summary.least_triangles,
        summary.most_triangles,
        100.0 * study.options.ratio,
        summary.mean_size_reduction,
        summary.mean_cost_size_reduction,
        summary.larger_share,
        summary.cost_larger_share,
        summary.much_smaller_share,
        summary.hausdorff_kept_share,
        summary.hausdorff_no_worse_share,
        summary.mean_no_worse_share);
    for (const auto& [limit, share] : summary.ips_below)
        text += fmt::format(" {:g}: {:.1f} %", limit, share);
    text += fmt::format(
        "\nsmall scenes expanded where that is smaller (ips-switch=size): {:.1f} % less, larger on "
        "{:.2f} %, Hausdorff kept on {:.1f} %; all files together: {:.1f} % less\n"
        "larger on {} models, on {} of them Quadric lost pieces; Hausdorff not kept on {}, on {} "
        "of "
        "them IAS removed instances, {} are worse by little\n"
        "Quadric lost pieces on {} models, {:.1f} % of all pieces",
        summary.mean_best_size_reduction,
        summary.best_larger_share,
        summary.best_hausdorff_kept_share,
        summary.all_size_reduction,
        summary.larger_models,
        summary.larger_that_lost,
        summary.worse_models,
        summary.worse_that_removed,
        summary.worse_by_little,
        summary.models_that_lost,
        summary.pieces_lost_share);
    return text + "\n";
}

} // namespace lodestone::bench
