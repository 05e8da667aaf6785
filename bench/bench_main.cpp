// lodestone_bench: every promised figure, measured beside its peers, as Markdown.
#include "bench/meshoptimizer_peer.h"
#include "bench/rows.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <exception>
#include <fmt/core.h>
#include <fstream>
#include <iostream>
#include <tbb/info.h>

namespace lodestone::bench {

namespace {

struct Section {
    std::string title;
    std::function<Result<void>(Bench&)> add;
};

// A section over one scene; without the scene it is left out and said so.
Section sceneSection(const std::string& title,
                     const std::function<Result<ScenePtr>(Inputs&)>& find,
                     const std::function<Result<void>(Bench&, const ScenePtr&)>& add) {
    return {title, [=](Bench& bench) -> Result<void> {
                const Result<ScenePtr> scene = find(bench.inputs);
                if (!scene)
                    return tl::unexpected(scene.error());
                if (*scene)
                    return add(bench, *scene);
                bench.table.tell("not measured: no such input", "");
                return {};
            }};
}

using AddScene = std::function<Result<void>(Bench&, const ScenePtr&, SketchInput)>;

// Rows for a scene of ours and, if a folder is given, for the one of the same name in it.
struct SceneRows {
    const char* title;
    const char* name;
    SketchInput ours; // what our scene is; a given one is the sketch's
    AddScene add;
};

void addBoth(std::vector<Section>& sections, const SceneRows& rows, const std::string& given) {
    sections.push_back(sceneSection(
        rows.title,
        [name = rows.name](Inputs& inputs) { return inputs.own(name); },
        [rows](Bench& bench, const ScenePtr& scene) { return rows.add(bench, scene, rows.ours); }));
    if (!given.empty())
        sections.push_back(sceneSection(
            std::string(rows.title) + " (given)",
            [name = rows.name](Inputs& inputs) { return inputs.given(name); },
            [rows](Bench& bench, const ScenePtr& scene) {
                return rows.add(bench, scene, SketchInput::Same);
            }));
}

AddScene alone(const AloneTargets& targets) {
    return [targets](Bench& bench, const ScenePtr& scene, SketchInput input) {
        return addAloneRows(bench, scene, targets, input);
    };
}

AddScene instanced(const InstancedTargets& targets) {
    return [targets](Bench& bench, const ScenePtr& scene, SketchInput input) {
        return addInstancedRows(bench, scene, targets, input);
    };
}

std::vector<Section> allSections(const std::string& given) {
    const auto equal = [](Bench& bench, const ScenePtr& scene, SketchInput) {
        return addEqualRows(bench, scene);
    };
    const auto cards = [](Bench& bench, const ScenePtr& scene, SketchInput) {
        return addCardRows(bench, scene);
    };
    constexpr SketchInput kSame = SketchInput::Same;
    constexpr SketchInput kAnother = SketchInput::Another;
    std::vector<Section> sections{sceneSection(
        "Stanford bunny",
        [](Inputs& inputs) { return inputs.stanfordBunny(); },
        [](Bench& bench, const ScenePtr& scene) {
            return addAloneRows(bench, scene, bunnyTargets(), kSame);
        })};
    addBoth(sections, {"Our bunny", "bunny", kAnother, alone(bunnyTargets())}, "");
    for (const SceneRows& rows :
         {SceneRows{"Displaced sphere", "sphere", kSame, alone(sphereTargets())},
          SceneRows{"Maple", "maple", kAnother, instanced(mapleTargets())},
          SceneRows{"Village", "village", kAnother, instanced(villageTargets())},
          SceneRows{"Maple at equal triangles", "maple", kAnother, equal},
          SceneRows{"Village at equal triangles", "village", kAnother, equal},
          SceneRows{"Leaf cards", "cards", kSame, cards}})
        addBoth(sections, rows, given);
    sections.push_back({"Read-out", addReadOutRows});
    sections.push_back({"Files and schedules", addFileRows});
    sections.push_back({"Memory", addMemoryRows});
    return sections;
}

std::string lowered(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return text;
}

struct Options {
    std::string out;
    std::string only;
    std::string given;
    std::string models = LODESTONE_SOURCE_DIR "/../shared/models";
    bool quick = false;
    bool memory_child = false;
};

int run(const Options& options) {
    std::ofstream file;
    if (!options.out.empty()) {
        file.open(options.out);
        if (!file) {
            std::cerr << "lodestone_bench: " << options.out << ": cannot be written\n";
            return exitCode(ErrorKind::Failed);
        }
    }
    Bench bench{Inputs(options.models, options.given),
                Table(options.out.empty() ? std::cout : file),
                options.quick ? 3 : 5};
    (options.out.empty() ? std::cout : file)
        << "# Figures\n\n"
        << fmt::format(
               "Times are CPU seconds on one thread, median (min–max) of {} rounds in which "
               "what is compared takes turns; ratios are medians over the rounds. Read-outs "
               "are wall time on two threads. Distances are % of the diagonal, 300,000 "
               "samples a side. Hardware threads: {}. Peer: {}.\n",
               bench.rounds,
               tbb::info::default_concurrency(),
               meshoptimizerName());
    int code = 0;
    for (const Section& section : allSections(options.given)) {
        if (lowered(section.title).find(lowered(options.only)) == std::string::npos)
            continue;
        std::cerr << section.title << '\n';
        bench.table.heading(section.title);
        const Result<void> added = section.add(bench);
        if (!added) {
            std::cerr << "lodestone_bench: " << section.title << ": " << added.error().message
                      << '\n';
            code = exitCode(added.error().kind);
        }
    }
    bench.table.finish();
    return code;
}

int parseAndRun(int argc, char** argv) {
    Options options;
    CLI::App app("Re-runs every promised figure beside its peers; Markdown on stdout.");
    app.add_option("--out", options.out, "write to this file instead of stdout");
    app.add_option("--only", options.only, "only sections whose title contains this");
    app.add_option("--inputs",
                   options.given,
                   "folder whose maple, village, sphere and cards .glb are measured too");
    app.add_option("--models", options.models, "folder of real models")->capture_default_str();
    app.add_flag("--quick", options.quick, "3 rounds instead of 5");
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
