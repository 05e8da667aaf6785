#pragma once
// One model of the study, by IAS and by Quadric on the expanded scene.
#include "bench/study/study_set.h"
#include "simplify/target.h"

#include <optional>

namespace lodestone::bench {

// A level of detail of one of the two.
struct StudyLevel {
    std::uint64_t triangles = 0;
    std::uint64_t bytes = 0; // GLB, storage chosen by itself, as predicted to the byte
    double hausdorff = 0.0;  // % of the diagonal, from the original
    double mean = 0.0;
};

struct StudyRow {
    std::string name;
    std::string kind;
    SceneCounts counts;
    std::uint64_t original_bytes = 0; // our export of the untouched scene
    StudyLevel ias;                   // ordering triangle
    StudyLevel by_cost;               // IAS in the paper's order
    StudyLevel by_size;               // IAS, small scenes expanded where that is smaller
    StudyLevel quadric;               // at no more triangles than IAS
    std::uint64_t removed = 0;        // instances that IAS removes
    std::uint64_t pieces = 0;         // connected ones that Quadric begins with
    std::uint64_t pieces_lost = 0;    // of these by Quadric
    std::string failure;              // empty: measured

    double ips() const; // instances per submesh that is drawn
    // Of IAS's file against Quadric's: 100 % is all, negative is larger.
    double sizeReductionPercent() const;
    double costSizeReductionPercent() const;
    double bestSizeReductionPercent() const; // by_size
};

struct StudyOptions {
    double ratio = 0.2;
    std::uint64_t samples = 50'000;           // of the distances, a side
    std::uint64_t most_triangles = 2'000'000; // instanced
};

// IAS at the target, Quadric at the count that IAS reaches.
// A model without triangles, or with more than `most_triangles`, or that cannot be read, has a
// failure that says so. Any thread.
StudyRow measureModel(const StudyModel& model, const StudyOptions& options);

// --- what the paper's table and its figure of the tree show

struct TableRow {
    std::string name;
    SceneCounts counts;
    std::uint64_t original_bytes = 0;
    double quadric_seconds = 0.0; // CPU, one thread, median: expansion, sequence, schedule
    double ias_seconds = 0.0;
    double time_ratio = 0.0; // median over the rounds
    StudyLevel quadric;      // at 20 %; distances are not measured
    StudyLevel by_cost;
    StudyLevel ias;
};

Result<TableRow> measureTableRow(const std::string& sample, int rounds);

struct SizeCurve {
    std::string name;
    std::vector<StudyLevel> levels; // falling triangles; distances are not measured
};

// Size over triangles: Quadric, IAS by cost, IAS by triangle.
Result<std::vector<SizeCurve>> measureSizeCurves(const ScenePtr& scene);

} // namespace lodestone::bench
