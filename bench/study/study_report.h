#pragma once
// What the study says, as CSV, JSON and one HTML page.
#include "bench/study/study_measure.h"

namespace lodestone::bench {

struct Study {
    StudyOptions options;
    std::vector<TableRow> table;
    std::uint64_t tree_bytes = 0; // of the untouched tree
    std::vector<SizeCurve> tree_curves;
    std::vector<StudyRow> rows; // those with a failure are told, and left out of all figures
};

// Figures over all rows without failure.
struct StudySummary {
    std::uint64_t models = 0;
    std::uint64_t failed = 0;
    double mean_size_reduction = 0.0;      // %, ordering triangle
    double mean_cost_size_reduction = 0.0; // %, ordering cost
    double larger_share = 0.0;             // % of models where IAS's file is larger
    double cost_larger_share = 0.0;
    double mean_best_size_reduction = 0.0; // %, small scenes expanded where that is smaller
    double best_larger_share = 0.0;
    double best_hausdorff_kept_share = 0.0;
    double all_size_reduction = 0.0; // % of the bytes of all files together
    std::uint64_t larger_models = 0;
    std::uint64_t larger_that_lost = 0;   // of these: Quadric lost pieces
    std::uint64_t worse_models = 0;       // Hausdorff not kept
    std::uint64_t worse_that_removed = 0; // of these: IAS removed instances
    std::uint64_t worse_by_little = 0;    // of these: less than 1.5 x Quadric's, or 0.5 % more
    std::uint64_t models_that_lost = 0;   // Quadric lost pieces
    double pieces_lost_share = 0.0;       // % of all pieces of all models
    double much_smaller_share = 0.0;      // % with more than 20 % less
    double hausdorff_kept_share = 0.0; // % with at most 1.05 x Quadric's + 0.02 % of the diagonal
    double hausdorff_no_worse_share = 0.0; // % with at most Quadric's
    double mean_no_worse_share = 0.0;      // % with at most Quadric's mean distance
    std::uint64_t least_triangles = 0;
    std::uint64_t most_triangles = 0;
    std::vector<std::pair<double, double>> ips_below; // limit, % of models with less
};

StudySummary summaryOf(const Study& study);

std::string studyCsv(const Study& study);
std::string studyJson(const Study& study);
std::string studyPage(const Study& study); // needs no other file; well-formed XML
std::string studyText(const Study& study); // a few lines for the terminal

} // namespace lodestone::bench
