#pragma once
// One algorithm on one scene, the way `simplify`, `compare` and `render` share.
#include "app/lane.h"

namespace lodestone {

struct StageSeconds {
    double load = 0.0;
    double sequence = 0.0;
    double schedule = 0.0;
    double readout = 0.0;
    double write = 0.0;
};

struct RunRequest {
    ScenePtr scene;                       // original
    const Algorithm* algorithm = nullptr; // nullptr: the original itself
    ParameterValues parameters;
    ScheduleOptions schedule;
    Target target;
    ExportOptions export_options;
    bool expand_first = false; // --scope expanded
    bool measure = false;
};

struct RunOutcome {
    std::string algorithm; // id, or "original"
    std::string name;      // "IAS"
    ScenePtr scene;        // whose submeshes `lod` replaces
    std::shared_ptr<const Lod> lod;
    std::uint64_t bytes = 0; // written, or what writing would give
    std::uint64_t predicted_bytes = 0;
    StageSeconds seconds;
    std::optional<Distance> distance;
    std::vector<std::string> notes;
    bool target_met = true;
    LodSourcePtr source; // null: the original
};

struct LoadedInput {
    ScenePtr scene;
    double seconds = 0.0;
};

Result<LoadedInput> loadInput(const std::filesystem::path& path, const JobContext& job);

// Builds, schedules, resolves, reads out, and measures if asked. Nothing is written.
// Errors: those of the algorithm; Cancelled.
Result<RunOutcome> runAlgorithm(const RunRequest& request, const JobContext& job);

// Distance of what a file holds from the original scene: writing one rounds. Errors: those of
// importing and measuring.
Result<Distance>
measureFile(const Scene& original, const std::filesystem::path& path, const JobContext& job);

} // namespace lodestone
