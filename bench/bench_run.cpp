#include "bench/bench_run.h"

#include "bench/attribute_table.h"
#include "bench/figures.h"
#include "bench/machine.h"
#include "bench/peers/process.h"
#include "bench/report.h"
#include "bench/rows_pointcloud.h"
#include "bench/sheet_json.h"
#include "bench/wild_table.h"

#include <algorithm>
#include <fmt/core.h>
#include <fstream>
#include <iostream>
#include <sstream>

namespace lodestone::bench {

namespace {

using Json = nlohmann::json;

enum class PartKind : std::uint8_t { Figures, Peers, Text };

// A part of the report, measured or not.
struct Planned {
    std::string name;
    PartKind kind = PartKind::Text;
    bool chosen = false;
    PartOrigin origin;
    std::function<Result<std::optional<Json>>()> measure; // none: there is no such input
    std::optional<Part> part;
    std::string failure;
    bool absent = false;
};

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

std::string figuresIntroduction(int rounds) {
    return fmt::format(
        "\n## Promised figures\n\n"
        "CPU seconds on one thread, median (min–max) of {} rounds in which what is "
        "compared takes turns; ratios are medians over the rounds. Read-outs are "
        "wall time on all threads. Distances are % of the diagonal, 300,000 samples "
        "a side, maxima exact. \"Sketch\": an early sketch of this design on its own machine, "
        "made comparable by what meshoptimizer takes on both; its maxima are those "
        "of samples and vertices, so ours are given as that beside it. Neither it nor "
        "meshoptimizer's simplify looks at attributes: where \"positions alone\" "
        "stands, and for all of a scene's errors, ours carries them along, too "
        "(uv-, normal-, color- and motion-weight 0); what the defaults cost is a "
        "row of its own.\n",
        rounds);
}

std::string peersIntroduction(const PeerBench& bench) {
    return fmt::format(
        "\n## Peers\n\n"
        "Every mesh to {:.0f} % of its triangles by the peer; ours to as many of the scene's. "
        "CPU seconds, median (min–max) of {} rounds in which all take turns; ours: whole sequence, "
        "schedule and read-out on one thread; peers: the call alone, or a process from file to "
        "file against our process (\"process\"). \"× ours\": the peer over ours at as many "
        "triangles, **bold** where the peer is better by more than 1 %. Bytes: written by our "
        "exporter, but for processes, which write their own file. Distance: two-sided, {} samples "
        "a side, % of the diagonal. FLIP: mean over 12 cameras, {} px square, lit, of the pixels "
        "that the original or the level of detail covers. Peers that take positions alone get each "
        "attribute of the nearest stored vertex.\n",
        100.0 * kPeerRatio,
        bench.rounds,
        bench.samples,
        bench.picture_px);
}

// NAME=VALUE of any edge-collapse method. Errors: Usage.
Result<ParameterValues> parametersOf(const BenchOptions& options) {
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

Result<std::optional<Json>> measureAttributes(const BenchOptions& options,
                                              const TitleFilter& wanted) {
    AttributeBench bench;
    bench.sheets = options.sheets;
    bench.picture_px = options.quick ? 128 : 256;
    Result<ParameterValues> parameters = parametersOf(options);
    if (!parameters)
        return tl::unexpected(parameters.error());
    bench.parameters = std::move(*parameters);
    // gltfpack's weights, and the same with textures as firm as normals.
    for (const PeerWeights& weights : {PeerWeights{0.5f, 1.0f, 0.0f}, {0.5f, 1.0f, 0.5f}}) {
        Result<MeshPeer> peer = webAssemblyPeer(options.npm, weights);
        if (!peer)
            return tl::unexpected(peer.error());
        bench.peers.push_back(std::move(*peer));
    }
    AttributeTable table;
    if (addAttributeTable(table, bench, options.models, wanted) != 0)
        return fail(ErrorKind::Failed, "some textured models could not be measured");
    if (table.rows.empty())
        return std::nullopt;
    return textJson({"", table.markdown});
}

Result<std::optional<Json>>
measurePointCloud(const BenchOptions& options, Inputs& inputs, const TitleFilter& wanted) {
    std::ostringstream text;
    if (writePointCloud(text,
                        inputs,
                        options.quick ? PointCloudExtent::Quick : PointCloudExtent::Full,
                        wanted) != 0)
        return fail(ErrorKind::Failed, "some scenes could not be measured");
    if (text.str().empty())
        return std::nullopt;
    return textJson(
        {"",
         "\n## Six point-cloud methods\n\n"
         "Thresholds as in the paper, for a bunny of its size. Frame: mean of the 100th to the "
         "1,100th rendering off screen, 256 px square, wall time, and CPU time of all threads "
         "(where the CPU draws, what else the machine does stays out of it), the original and all "
         "others in turns of 10 frames, as many turns as fit 200 seconds; change: against the "
         "original, median over the turns (the paper: 23–30 % faster). Build: CPU seconds on all "
         "threads from the scene to the LOD. Distances are % of the diagonal.\n" +
             text.str()});
}

Result<std::optional<Json>> measureWild(Inputs& inputs, const TitleFilter& wanted) {
    WildTable table;
    if (addWildTable(table, inputs, wanted) != 0)
        std::cerr << "lodestone_bench: some models could not be measured; the table says why\n";
    return textJson({"", table.markdown});
}

Result<std::optional<Json>> measureHotPaths([[maybe_unused]] const BenchOptions& options) {
    TextSheet sheet;
    sheet.tables = "\n## Hot paths\n\nCPU time of one iteration on one thread, median (min–max) "
                   "of 5 repetitions in random order, over that of a reference kernel of the same "
                   "run. \"Before\": bench/micro_baseline.json.\n\n";
#ifdef LODESTONE_MICROBENCH
    // It exits with 1 if a path has become slower; that line is in its output, as this is.
    const std::string script = "\"$0\" \"$@\" || echo \"- exit code $?\"";
    const std::string baseline = std::string(LODESTONE_SOURCE_DIR) + "/bench/micro_baseline.json";
    const std::string seconds = options.quick ? "0.02" : "0.2";
    const Result<Ran> ran = runProgram(
        {"sh", "-c", script, LODESTONE_MICROBENCH, "--baseline", baseline, "--seconds", seconds});
    if (!ran)
        return tl::unexpected(ran.error());
    sheet.tables += ran->output;
#else
    sheet.tables += "Not measured: Google Benchmark was not found: install libbenchmark-dev.\n";
#endif
    return textJson(sheet);
}

class Run {
public:
    explicit Run(const BenchOptions& options)
        : options_(options), parts_(options.parts), inputs_(options.models, options.given),
          commit_(commitText()), machine_(machineText()) {
        planFigures();
        planPeers();
        planTexts();
    }

    int run() {
        for (Planned& planned : plan_)
            if (!options_.again || !planned.chosen)
                planned.part = parts_.find(planned.name, planned.origin);
        for (Planned& planned : plan_)
            if (planned.chosen && !planned.part) {
                measure(planned);
                if (!options_.out.empty())
                    write();
            }
        write();
        return exit_code_;
    }

private:
    bool wanted(const std::string& title) const {
        return lowered(title).find(lowered(options_.only)) != std::string::npos;
    }

    // Whether a flag was given, or none at all.
    bool asked(bool flag) const {
        return flag || !(options_.figures || options_.peers || options_.attributes ||
                         options_.pointcloud || options_.wild || options_.micro);
    }

    // what: "5 rounds".
    PartOrigin originOf(const std::string& how) const {
        const bool of_one_commit =
            commit_.find("(with changes)") == std::string::npos && commit_ != "unknown";
        return {of_one_commit ? commit_ : "", how, 0.0};
    }

    std::string roundsText() const {
        return options_.quick ? "one round (--quick)" : fmt::format("{} rounds", options_.rounds);
    }

    int rounds() const { return options_.quick ? 1 : options_.rounds; }

    void planFigures() {
        for (const FigureSection& section : figureSections(options_.given))
            plan_.push_back(
                {"figures: " + section.title,
                 PartKind::Figures,
                 asked(options_.figures) && wanted(section.title),
                 originOf(roundsText()),
                 [this, section]() -> Result<std::optional<Json>> {
                     std::ostringstream text;
                     Bench bench{inputs_, Table(text), rounds()};
                     bench.table.heading(section.title);
                     if (const Result<void> added = section.add(bench); !added)
                         return tl::unexpected(added.error());
                     return figureJson(
                         {section.title, text.str(), bench.table.met(), bench.table.missed()});
                 },
                 {},
                 {}});
    }

    void planPeers() {
        MeshPeers meshes = meshPeers(options_.npm);
        FilePeers files = filePeers(options_.npm, kPeerRatio);
        for (const std::vector<AbsentPeer>* absent : {&meshes.absent, &files.absent})
            for (const AbsentPeer& peer : *absent)
                absent_peers_.push_back(peer.name + ": " + peer.why);
        peers_.meshes = std::move(meshes.present);
        peers_.files = std::move(files.present);
        peers_.lodestone = LODESTONE_BINARY;
        peers_.rounds = rounds();
        if (options_.quick) {
            peers_.samples = 100'000;
            peers_.picture_px = 128;
        }
        const std::string how =
            fmt::format("{}, {} peers", roundsText(), peers_.meshes.size() + peers_.files.size());
        for (const PeerSection& section : peerSections())
            plan_.push_back({"peers: " + section.title,
                             PartKind::Peers,
                             asked(options_.peers) && wanted(section.title) &&
                                 (section.quick || !options_.quick),
                             originOf(how),
                             [this, section]() -> Result<std::optional<Json>> {
                                 const auto sheet = section.measure(peers_, inputs_);
                                 if (!sheet)
                                     return tl::unexpected(sheet.error());
                                 if (!*sheet)
                                     return std::nullopt;
                                 return sheetJson(**sheet);
                             },
                             {},
                             {}});
    }

    void planTexts() {
        const TitleFilter wanted_title = [this](const std::string& title) { return wanted(title); };
        std::string parameters;
        for (const std::string& parameter : options_.parameters)
            parameters += ", " + parameter;
        // What is named by its filter is never taken for the whole.
        const std::string those = options_.only.empty() ? "" : ", those with " + options_.only;
        planText("textured models" + parameters + those, asked(options_.attributes), [=, this] {
            return measureAttributes(options_, wanted_title);
        });
        planText("six point-cloud methods" + those, asked(options_.pointcloud), [=, this] {
            return measurePointCloud(options_, inputs_, wanted_title);
        });
        planText("Wild" + those, asked(options_.wild), [=, this] {
            return measureWild(inputs_, wanted_title);
        });
        planText("hot paths", asked(options_.micro) && wanted("hot paths"), [this] {
            return measureHotPaths(options_);
        });
    }

    void planText(const std::string& name,
                  bool chosen,
                  std::function<Result<std::optional<Json>>()> measure) {
        plan_.push_back({name,
                         PartKind::Text,
                         chosen,
                         originOf(options_.quick ? "--quick" : ""),
                         std::move(measure),
                         {},
                         {}});
    }

    void measure(Planned& planned) {
        const auto number = std::ranges::count_if(
            plan_, [](const Planned& other) { return other.chosen && other.part; });
        const auto chosen = std::ranges::count_if(plan_, &Planned::chosen);
        std::cerr << fmt::format("[{}/{}] {}\n", number + 1, chosen, planned.name);
        const double start = wallSeconds();
        Result<std::optional<Json>> content = planned.measure();
        if (!content) {
            planned.failure = content.error().message;
            std::cerr << "lodestone_bench: " << planned.name << ": " << planned.failure << '\n';
            exit_code_ = exitCode(content.error().kind);
            return;
        }
        planned.absent = !*content;
        if (planned.absent)
            return;
        planned.part = Part{planned.name, planned.origin, std::move(**content)};
        planned.part->origin.seconds = wallSeconds() - start;
        if (const Result<void> kept = parts_.keep(*planned.part); !kept)
            told(kept.error());
    }

    void told(const Error& error) {
        std::cerr << "lodestone_bench: " << error.message << '\n';
        exit_code_ = exitCode(error.kind);
    }

    Report report() const {
        Report report;
        report.commit = commit_;
        report.machine = machine_;
        report.how = roundsText();
        report.figures_introduction = figuresIntroduction(rounds());
        report.peers_introduction = peersIntroduction(peers_);
        for (const Planned& planned : plan_) {
            if (planned.part)
                add(report, planned);
            else if (planned.absent)
                report.absent.push_back(planned.name + ": no such model here");
            else if (!planned.failure.empty())
                report.failed.push_back(planned.name + ": " + planned.failure);
            else if (planned.chosen)
                report.open.push_back(planned.name);
        }
        if (!report.board.empty())
            report.absent.insert(report.absent.end(), absent_peers_.begin(), absent_peers_.end());
        return report;
    }

    static void add(Report& report, const Planned& planned) {
        const Json& content = planned.part->content;
        report.seconds += planned.part->origin.seconds;
        switch (planned.kind) {
        case PartKind::Figures:
            report.figures.push_back(figureOf(content));
            break;
        case PartKind::Peers:
            report.board.add(sheetOf(content));
            break;
        case PartKind::Text:
            report.texts.push_back(textOf(content));
            break;
        }
    }

    void write() {
        const Report now = report();
        if (options_.out.empty())
            std::cout << markdown(now);
        else
            writeFile(options_.out, markdown(now));
        if (!options_.csv.empty())
            writeFile(options_.csv, now.board.csv());
    }

    void writeFile(const std::string& path, const std::string& text) {
        std::ofstream file(path);
        file << text;
        if (!file.flush())
            told(Error{ErrorKind::Failed, path + ": cannot be written"});
    }

    const BenchOptions& options_;
    Parts parts_;
    Inputs inputs_;
    std::string commit_;
    std::string machine_;
    PeerBench peers_;
    std::vector<std::string> absent_peers_;
    std::vector<Planned> plan_;
    int exit_code_ = 0;
};

} // namespace

int runBench(const BenchOptions& options) {
    return Run(options).run();
}

} // namespace lodestone::bench
