#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"

#include <CLI/CLI.hpp>
#include <ostream>

namespace lodestone {

namespace {

struct DistanceCommandOptions {
    std::string a;
    std::string b;
    std::string samples;
    bool json = false;
};

Result<void> runDistance(const DistanceCommandOptions& options, const CliEnvironment& environment) {
    constexpr std::uint64_t kMostSamples = 1'000'000'000;
    DistanceOptions distance_options;
    if (!options.samples.empty()) {
        const auto samples = parseCount("--samples", options.samples, 1, kMostSamples);
        if (!samples)
            return tl::unexpected<Error>(samples.error());
        distance_options.samples = *samples;
    }
    ProgressBar bar(environment);
    bar.stage("read");
    const Result<LoadedInput> a = loadInput(options.a, bar.context());
    if (!a)
        return tl::unexpected<Error>(a.error());
    const Result<LoadedInput> b = loadInput(options.b, bar.context());
    if (!b)
        return tl::unexpected<Error>(b.error());
    bar.stage("measure");
    const Lod lod_a = fullLod(*a->scene);
    const Lod lod_b = fullLod(*b->scene);
    const Result<Distance> distance = measureDistance(
        {a->scene.get(), &lod_a}, {b->scene.get(), &lod_b}, distance_options, bar.context());
    if (!distance)
        return tl::unexpected<Error>(distance.error());
    bar.finish();
    environment.out << (options.json ? distanceJson(*distance) : distanceText(*distance));
    return {};
}

} // namespace

void addDistanceCommand(CLI::App& app, ChosenCommand& chosen) {
    const auto options = std::make_shared<DistanceCommandOptions>();
    CLI::App& command =
        *app.add_subcommand("distance", "how far the surfaces of two files are apart");
    command.add_option("A", options->a, "reference; percentages are of its diagonal")->required();
    command.add_option("B", options->b, "the other file")->required();
    command.add_option("--samples", options->samples, "points on each surface (default 300000)")
        ->type_name("N");
    command.add_flag("--json", options->json, "one JSON object on stdout");
    addThreadsOption(command, chosen);
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runDistance(*options, environment);
        };
    });
}

} // namespace lodestone
