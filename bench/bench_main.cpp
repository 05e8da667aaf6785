// lodestone_bench: every promised figure, peers beside us, the six point-cloud methods, and the
// micro-benchmarks, as Markdown.
#include "bench/attribute_table.h"
#include "bench/figures.h"
#include "bench/machine.h"
#include "bench/peers/process.h"
#include "bench/rows_pointcloud.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <fmt/core.h>
#include <fstream>
#include <iostream>
#include <sstream>

namespace lodestone::bench {

namespace {

struct Options {
    std::string out;
    std::string csv;
    std::string only;
    std::string given;
    std::string models = LODESTONE_SOURCE_DIR "/../shared/models";
    std::string npm = LODESTONE_BENCH_NPM;
    std::string sheets;
    std::vector<std::string> parameters; // of ours in the table of textured models
    bool attributes = false;
    bool figures = false;
    bool peers = false;
    bool pointcloud = false;
    bool micro = false;
    bool quick = false;
    bool memory_child = false;

    bool everything() const { return !attributes && !figures && !peers && !pointcloud && !micro; }
};

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

// The parts of the report; what a part's summary says comes before all tables.
struct Report {
    std::string summary;
    std::string tables;
    int exit_code = 0;
};

void addFiguresPart(Report& report,
                    const Options& options,
                    Inputs& inputs,
                    const TitleFilter& wanted) {
    std::ostringstream text;
    Bench bench{inputs, Table(text), options.quick ? 1 : 5};
    const int code = addFigures(bench, options.given, wanted);
    report.exit_code = std::max(report.exit_code, code);
    report.summary += "\n### Promised figures\n\n" + bench.table.summary();
    report.tables +=
        fmt::format("\n## Promised figures\n\n"
                    "CPU seconds on one thread, median (min–max) of {} rounds in which what is "
                    "compared takes turns; ratios are medians over the rounds. Read-outs are wall "
                    "time on all threads. Distances are % of the diagonal, 300,000 samples a side. "
                    "\"Sketch\": an early sketch of this design on its own machine, made "
                    "comparable by what meshoptimizer takes on both.\n",
                    bench.rounds) +
        text.str();
}

std::string absentText(const PeerRun& run, const MeshPeers& meshes, const FilePeers& files) {
    std::string text;
    for (const std::vector<AbsentPeer>* absent : {&meshes.absent, &files.absent})
        for (const AbsentPeer& peer : *absent)
            text += fmt::format("- not measured: {}: {}\n", peer.name, peer.why);
    for (const std::string& input : run.absent)
        text += fmt::format("- not measured: the input {}: no such model here\n", input);
    return text;
}

std::string peersIntroduction(const PeerBench& bench) {
    return fmt::format(
        "\n## Peers\n\n"
        "Every mesh to {:.0f} % of its triangles by the peer; ours to as many of the scene's. "
        "CPU seconds, median (min–max) of {} rounds in which all take turns; ours: whole sequence, "
        "schedule and read-out on one thread; peers: the call alone, or a process from file to "
        "file "
        "against our process (\"process\"). \"× ours\": the peer over ours at as many triangles, "
        "**bold** where the peer is better by more than 1 %. Bytes: written by our exporter, but "
        "for processes, which write their own file. Distance: two-sided, {} samples a side, % of "
        "the diagonal. FLIP: mean over 12 cameras, {} px square, lit. Peers that take positions "
        "alone get each attribute of the nearest stored vertex.\n",
        100.0 * kPeerRatio,
        bench.rounds,
        bench.samples,
        bench.picture_px);
}

void addPeersPart(Report& report,
                  const Options& options,
                  Inputs& inputs,
                  const TitleFilter& wanted) {
    MeshPeers meshes = meshPeers(options.npm);
    FilePeers files = filePeers(options.npm, kPeerRatio);
    PeerBench bench;
    bench.meshes = meshes.present;
    bench.files = files.present;
    bench.lodestone = LODESTONE_BINARY;
    if (options.quick) {
        bench.rounds = 1;
        bench.samples = 100'000;
        bench.picture_px = 128;
    }
    PeerRun run;
    const int code =
        addPeers(run, bench, inputs, options.quick ? PeerInputs::Few : PeerInputs::All, wanted);
    report.exit_code = std::max(report.exit_code, code);
    if (!run.board.empty())
        report.summary += "\n### Peers\n\n" + run.board.summary();
    report.summary += "\n" + absentText(run, meshes, files);
    report.tables += peersIntroduction(bench);
    for (const std::string& table : run.tables)
        report.tables += table;
    if (options.csv.empty())
        return;
    std::ofstream csv(options.csv);
    csv << run.board.csv();
    if (!csv.flush()) {
        std::cerr << "lodestone_bench: " << options.csv << ": cannot be written\n";
        report.exit_code = exitCode(ErrorKind::Failed);
    }
}

// NAME=VALUE of any edge-collapse method. Errors: Usage.
Result<ParameterValues> parametersOf(const Options& options) {
    ParameterValues values;
    const Algorithm& algorithm = *findAlgorithm("ias");
    for (const std::string& text : options.parameters) {
        const std::size_t equals = std::min(text.find('='), text.size() - 1);
        const std::string name = text.substr(0, equals);
        const Result<double> value = parseParameter(algorithm, name, text.substr(equals + 1));
        if (!value)
            return tl::unexpected(value.error());
        values[name] = *value;
    }
    return values;
}

void addAttributesPart(Report& report, const Options& options, const TitleFilter& wanted) {
    AttributeBench bench;
    bench.sheets = options.sheets;
    bench.picture_px = options.quick ? 128 : 256;
    Result<ParameterValues> parameters = parametersOf(options);
    if (!parameters) {
        std::cerr << "lodestone_bench: " << parameters.error().message << '\n';
        report.exit_code = exitCode(parameters.error().kind);
        return;
    }
    bench.parameters = std::move(*parameters);
    // gltfpack's weights, and the same with textures as firm as normals.
    for (const PeerWeights& weights : {PeerWeights{0.5f, 1.0f, 0.0f}, {0.5f, 1.0f, 0.5f}}) {
        Result<MeshPeer> peer = webAssemblyPeer(options.npm, weights);
        if (!peer) {
            report.summary +=
                "\n- not measured: textured models: meshoptimizer of npm: " + peer.error().message +
                "\n";
            return;
        }
        bench.peers.push_back(std::move(*peer));
    }
    AttributeTable table;
    const int code = addAttributeTable(table, bench, options.models, wanted);
    report.exit_code = std::max(report.exit_code, code);
    report.tables += table.markdown;
}

void addPointCloudPart(Report& report,
                       const Options& options,
                       Inputs& inputs,
                       const TitleFilter& wanted) {
    std::ostringstream text;
    const int code = writePointCloud(
        text, inputs, options.quick ? PointCloudExtent::Quick : PointCloudExtent::Full, wanted);
    report.exit_code = std::max(report.exit_code, code);
    report.tables +=
        "\n## Six point-cloud methods\n\n"
        "Thresholds as in the paper, for a bunny of its size. Frame: mean of the 100th to the "
        "1,100th rendering off screen, 256 px square, wall time, as many of them as fit 10 s; "
        "change: against the original in the same run (the paper: 23–30 % faster). Build: CPU "
        "seconds on all threads from the scene to the LOD. Distances are % of the diagonal.\n" +
        text.str();
}

void addMicroPart(Report& report, [[maybe_unused]] const Options& options) {
    report.tables +=
        "\n## Hot paths\n\nCPU time of one iteration on one thread, median (min–max) "
        "of 5 repetitions in random order, over that of a reference kernel of the same "
        "run. \"Before\": bench/micro_baseline.json.\n\n";
#ifdef LODESTONE_MICROBENCH
    std::cerr << "hot paths\n";
    // It exits with 1 if a path has become slower; that line is in its output, as this is.
    const std::string script = "\"$0\" \"$@\" || echo \"- exit code $?\"";
    const std::string baseline = std::string(LODESTONE_SOURCE_DIR) + "/bench/micro_baseline.json";
    const std::string seconds = options.quick ? "0.02" : "0.2";
    const Result<Ran> ran = runProgram(
        {"sh", "-c", script, LODESTONE_MICROBENCH, "--baseline", baseline, "--seconds", seconds});
    if (!ran) {
        std::cerr << "lodestone_bench: " << ran.error().message << '\n';
        report.exit_code = exitCode(ran.error().kind);
        return;
    }
    report.tables += ran->output;
#else
    report.tables += "Not measured: Google Benchmark was not found: install libbenchmark-dev.\n";
#endif
}

int writeReport(const Options& options, const Report& report, const std::string& machine) {
    const std::string text = fmt::format("# Results\n\n"
                                         "Written by `lodestone_bench`{} at commit {}.\n\n"
                                         "{}\n## Summary\n{}{}",
                                         options.quick ? " --quick" : "",
                                         commitText(),
                                         machine,
                                         report.summary,
                                         report.tables);
    if (options.out.empty()) {
        std::cout << text;
        return report.exit_code;
    }
    std::ofstream file(options.out);
    file << text;
    if (file.flush())
        return report.exit_code;
    std::cerr << "lodestone_bench: " << options.out << ": cannot be written\n";
    return exitCode(ErrorKind::Failed);
}

int run(const Options& options) {
    const std::string machine = machineText();
    const TitleFilter wanted = [only = lowered(options.only)](const std::string& title) {
        return lowered(title).find(only) != std::string::npos;
    };
    Inputs inputs(options.models, options.given);
    Report report;
    if (options.figures || options.everything())
        addFiguresPart(report, options, inputs, wanted);
    if (options.peers || options.everything())
        addPeersPart(report, options, inputs, wanted);
    if (options.attributes || options.everything())
        addAttributesPart(report, options, wanted);
    if (options.pointcloud || options.everything())
        addPointCloudPart(report, options, inputs, wanted);
    if (options.micro || options.everything())
        addMicroPart(report, options);
    return writeReport(options, report, machine);
}

int parseAndRun(int argc, char** argv) {
    Options options;
    CLI::App app("Measures every promised figure, peers beside us and the hot paths; Markdown.");
    app.add_option("--out", options.out, "write to this file instead of stdout");
    app.add_option("--csv", options.csv, "also write the peers' rows to this file");
    app.add_option("--only", options.only, "only figures and inputs whose title contains this");
    app.add_option("--inputs",
                   options.given,
                   "folder whose maple, village, sphere and cards .glb get figures too");
    app.add_option("--models", options.models, "folder of real models")->capture_default_str();
    app.add_option("--npm", options.npm, "node_modules with the peers of npm")
        ->capture_default_str();
    app.add_option("--sheets", options.sheets, "folder for contact sheets of textured models");
    app.add_option("--param",
                   options.parameters,
                   "NAME=VALUE of ours in the table of textured models; may be repeated");
    app.add_flag("--attributes", options.attributes, "textured models (default: every part)");
    app.add_flag("--figures", options.figures, "the promised figures (default: every part)");
    app.add_flag("--peers", options.peers, "peers beside us (default: every part)");
    app.add_flag(
        "--pointcloud", options.pointcloud, "the six point-cloud methods (default: every part)");
    app.add_flag("--micro", options.micro, "the micro-benchmarks (default: every part)");
    app.add_flag("--quick", options.quick, "one round instead of five, fewer inputs");
    app.add_flag("--memory-child", options.memory_child)->group(""); // how it starts itself
    CLI11_PARSE(app, argc, argv);
    return options.memory_child ? runMemoryChild() : run(options);
}

} // namespace

} // namespace lodestone::bench

int main(int argc, char** argv) {
    try {
        return lodestone::bench::parseAndRun(argc, argv);
    } catch (const std::exception& exception) { // out of memory, or a bug
        std::cerr << "lodestone_bench: " << exception.what() << '\n';
        return lodestone::exitCode(lodestone::ErrorKind::Failed);
    }
}
