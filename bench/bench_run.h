#pragma once
// The whole bench: what is to be measured, part after part, and the report of it.
#include <string>
#include <vector>

namespace lodestone::bench {

struct BenchOptions {
    std::string out;    // Markdown; empty: stdout, at the end
    std::string csv;    // the peers' rows; empty: not written
    std::string parts;  // folder where parts are kept; empty: not kept
    std::string only;   // what a title must contain, in any case; empty: all
    std::string given;  // folder of further scenes, empty: none
    std::string models; // folder of real models
    std::string npm;    // node_modules with peers
    std::string sheets; // folder for contact sheets of textured models; empty: none
    std::vector<std::string> parameters; // NAME=VALUE, of ours for textured models
    int rounds = 5;
    bool figures = false; // none of these six: all of them
    bool peers = false;
    bool attributes = false;
    bool pointcloud = false;
    bool wild = false;
    bool micro = false;
    bool quick = false; // one round, fewer inputs, samples and pixels
    bool again = false; // measure what is kept, too
};

// Measures what is chosen and not kept, and writes the report anew after every part. Parts that are
// kept but not chosen are in the report. What fails is told on stderr and in the report.
// Returns the exit code. Main thread (it draws).
int runBench(const BenchOptions& options);

} // namespace lodestone::bench
