// lodestone_bench: every promised figure, peers beside us, the six point-cloud methods, Wild, and
// the micro-benchmarks, as Markdown; or the study of instance-aware simplification.
#include "bench/bench_run.h"
#include "bench/program_main.h"
#include "bench/rows.h"
#include "bench/study/study.h"

#include <CLI/CLI.hpp>

namespace lodestone::bench {

namespace {

void addWhereTo(CLI::App& app, BenchOptions& options) {
    app.add_option(
        "--out", options.out, "write to this file, anew after every part, instead of stdout");
    app.add_option("--csv", options.csv, "also write the peers' rows to this file");
    app.add_option(
        "--parts",
        options.parts,
        "folder to keep each part in: a later run at the same commit goes on from there");
    app.add_option("--sheets", options.sheets, "folder for contact sheets of textured models");
}

void addWhat(CLI::App& app, BenchOptions& options) {
    app.add_option("--only", options.only, "only figures and inputs whose title contains this");
    app.add_option("--inputs",
                   options.given,
                   "folder whose maple, village, sphere and cards .glb get figures too");
    app.add_option("--models", options.models, "folder of real models")->capture_default_str();
    app.add_option("--npm", options.npm, "node_modules with the peers of npm")
        ->capture_default_str();
    app.add_option("--param",
                   options.parameters,
                   "NAME=VALUE of ours in the table of textured models; may be repeated");
    app.add_option("--rounds", options.rounds, "of what is timed in turns")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    app.add_flag("--figures", options.figures, "the promised figures (default: every part)");
    app.add_flag("--peers", options.peers, "peers beside us (default: every part)");
    app.add_flag("--attributes", options.attributes, "textured models (default: every part)");
    app.add_flag(
        "--pointcloud", options.pointcloud, "the six point-cloud methods (default: every part)");
    app.add_flag("--wild", options.wild, "Wild and texture transfer (default: every part)");
    app.add_flag("--micro", options.micro, "the micro-benchmarks (default: every part)");
    app.add_flag("--quick", options.quick, "one round instead of five, fewer inputs");
    app.add_flag("--again", options.again, "measure what is kept, too");
}

int parseAndRun(int argc, char** argv) {
    BenchOptions options;
    options.models = LODESTONE_SOURCE_DIR "/../shared/models";
    options.npm = LODESTONE_BENCH_NPM;
    bool memory_child = false;
    CLI::App app("Measures every promised figure, peers beside us and the hot paths; Markdown.");
    addWhereTo(app, options);
    addWhat(app, options);
    app.add_flag("--memory-child", memory_child)->group(""); // how it starts itself
    bool study = false;
    StudyRun study_run;
    app.add_flag("--study",
                 study,
                 "nothing but the instance-aware paper's evaluation: study.csv, .json and .html in "
                 "the folder --out");
    app.add_option("--made", study_run.made, "made scenes of the study")
        ->check(CLI::Range(0, 10'000))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (study) {
        study_run.folder = options.out.empty() ? "." : options.out;
        study_run.models = options.models;
        study_run.rounds = options.quick ? 1 : study_run.rounds;
        return runStudy(study_run);
    }
    return memory_child ? runMemoryChild() : runBench(options);
}

} // namespace

} // namespace lodestone::bench

int main(int argc, char** argv) {
    using namespace lodestone::bench;
    return programMain("lodestone_bench", parseAndRun, argc, argv);
}
