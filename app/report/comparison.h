#pragma once
// Algorithms run side by side on one scene: all that `compare` tells, as plain data.
#include "app/cli_progress.h"
#include "app/cli_run.h"
#include "app/report/byte_parts.h"
#include "app/report/machine.h"

namespace lodestone {

// One level of detail along a curve.
struct CurvePoint {
    std::uint64_t triangles = 0; // instanced
    std::uint64_t bytes = 0;     // predicted
    double hausdorff = 0.0;      // % of the diagonal
    double mean = 0.0;
};

struct ComparisonRow {
    const Algorithm* algorithm = nullptr; // nullptr: the original
    RunOutcome outcome;                   // bytes: of the file that was written to find out
    ByteParts parts;                      // of that file
    std::optional<ImageDifference> image; // none: no pictures, or the original
    std::vector<CurvePoint> curve;        // falling triangles; Depth::Page only
    std::string picture_png;              // PNG bytes; empty: no pictures, or Depth::Numbers
    std::string failure;                  // one line: the algorithm failed, all else is empty

    bool failed() const { return !failure.empty(); }
};

struct ModelFacts {
    std::string name;
    SceneCounts counts;
    std::uint64_t materials = 0;
    std::uint64_t images = 0;
    std::uint64_t file_bytes = 0; // 0: made by the program
    double diagonal = 0.0;
    std::vector<std::string> notes;
};

struct Comparison {
    ModelFacts model;
    Target target;
    ComparisonRow original;
    std::vector<ComparisonRow> rows; // [algorithms]
    std::string pictures_missing;    // why; empty: they are there
    MachineFacts machine;
};

struct ComparisonRequest {
    enum class Depth : std::uint8_t {
        Numbers, // one level of detail each
        Page,    // also pictures and curves
    };

    LoadedInput input;
    std::vector<const Algorithm*> algorithms;
    Target target;
    Depth depth = Depth::Numbers;
};

// Runs every algorithm at the target; writes each result to a temporary file to know its bytes;
// measures distance and, where pictures can be drawn, the image difference. An algorithm that fails
// becomes a row that says so. Errors: Cancelled; the first failure if every algorithm failed; disk.
// images: null draws none. Main thread (it draws).
Result<Comparison>
runComparison(const ComparisonRequest& request, ImageSource* images, ProgressBar& bar);

// Rows that may be best at something: what has more triangles than it was asked for has not won by
// being closer. All that did not fail where none reached the target.
std::vector<const ComparisonRow*> competingRows(const Comparison& comparison);

// How far the row's result is from the target, relative to it: 0.02 is 2 % above. None for targets
// that are errors, and for failures.
std::optional<double> targetDeviation(const Comparison& comparison, const ComparisonRow& row);

} // namespace lodestone
