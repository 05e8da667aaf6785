#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"
#include "scene/generate.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <limits>
#include <ostream>

namespace lodestone {

namespace {

struct GenerateOptions {
    std::string name;
    std::string output;
    std::string seed = "1";
    std::string compress = "none";
};

std::string sampleList() {
    std::string names;
    for (const std::string_view name : sampleNames())
        names += (names.empty() ? "" : ", ") + std::string(name);
    return names;
}

Result<void> runGenerate(const GenerateOptions& options, const CliEnvironment& environment) {
    const auto seed =
        parseCount("--seed", options.seed, 0, std::numeric_limits<std::uint64_t>::max());
    if (!seed)
        return tl::unexpected<Error>(seed.error());
    if (Result<void> usable = checkOutput(options.output, exportExtensions()); !usable)
        return usable;
    const auto compression = parseCompression(options.compress);
    if (!compression)
        return tl::unexpected<Error>(compression.error());
    ProgressBar bar(environment);
    bar.stage(fmt::format("make {}", options.name));
    const Result<ScenePtr> scene = generateScene(options.name, *seed);
    if (!scene)
        return tl::unexpected<Error>(scene.error());
    if (environment.stop.stop_requested())
        return cancelled();
    bar.stage("write");
    const Result<ExportReport> report =
        exportScene(**scene,
                    fullLod(**scene),
                    options.output,
                    {Instancing::Auto, Container::Glb, *compression});
    if (!report)
        return tl::unexpected<Error>(report.error());
    bar.finish();
    const SceneCounts counts = countScene(**scene);
    environment.out << fmt::format("{}: {} submeshes, {} instances, {} triangles ({} unique), {}\n",
                                   options.output,
                                   thousands(counts.submeshes),
                                   thousands(counts.instances),
                                   thousands(counts.triangles),
                                   thousands(counts.unique_triangles),
                                   humanBytes(report->bytes));
    return {};
}

} // namespace

void addGenerateCommand(CLI::App& app, ChosenCommand& chosen) {
    const auto options = std::make_shared<GenerateOptions>();
    CLI::App& command = *app.add_subcommand("generate", "write a sample scene");
    command.add_option("NAME", options->name, sampleList())->required();
    command.add_option("-o,--output", options->output, "file to write: .glb or .gltf")
        ->required()
        ->type_name("OUT");
    command.add_option("--seed", options->seed, "another variant of it (default 1)")
        ->type_name("N");
    command.add_option("--compress", options->compress, "none | quantize | meshopt | draco")
        ->type_name("HOW");
    addThreadsOption(command, chosen);
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runGenerate(*options, environment);
        };
    });
}

} // namespace lodestone
