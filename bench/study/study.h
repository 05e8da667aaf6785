#pragma once
#include <cstdint>
#include <string>

namespace lodestone::bench {

struct StudyRun {
    std::string folder;       // for study.csv, study.json and study.html
    std::string models;       // folder of real models, may be absent
    std::uint32_t made = 720; // made scenes beside the real ones
    int rounds = 3;           // of the table's times
};

// Re-runs the evaluation of the instance-aware paper: its table, its size curve, its set of models.
// Progress on stderr, the summary on stdout. Returns the exit code. Main thread.
int runStudy(const StudyRun& run);

} // namespace lodestone::bench
