#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"
#include "app/file_text.h"
#include "scene/generate.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <ostream>

namespace lodestone {

namespace {

struct CompareOptions {
    std::string input;
    std::string algorithms = "all";
    TargetTexts target;
    std::string csv;
    bool json = false;
};

struct Comparison {
    RunOutcome original;
    std::vector<RunOutcome> rows; // [algorithms]
};

struct ComparisonRequest {
    LoadedInput input;
    std::vector<const Algorithm*> algorithms;
    Target target;
};

Result<Comparison> compareAlgorithms(const ComparisonRequest& request, ProgressBar& bar) {
    RunRequest run;
    run.scene = request.input.scene;
    run.target = request.target;
    Comparison comparison;
    Result<RunOutcome> original = runAlgorithm(run, bar.context());
    if (!original)
        return tl::unexpected<Error>(std::move(original.error()));
    comparison.original = std::move(*original);
    comparison.original.seconds.load = request.input.seconds;
    run.measure = true;
    for (const Algorithm* algorithm : request.algorithms) {
        bar.stage(fmt::format("compare {}", algorithm->id));
        run.algorithm = algorithm;
        Result<RunOutcome> row = runAlgorithm(run, bar.context());
        if (!row) {
            row.error().message = fmt::format("{}: {}", algorithm->id, row.error().message);
            return tl::unexpected<Error>(std::move(row.error()));
        }
        row->seconds.load = request.input.seconds;
        comparison.rows.push_back(std::move(*row));
    }
    return comparison;
}

Result<void> runCompare(const CompareOptions& options, const CliEnvironment& environment) {
    const auto target = parseTarget(options.target);
    if (!target)
        return tl::unexpected<Error>(target.error());
    auto chosen = algorithmsFromList(options.algorithms);
    if (!chosen)
        return tl::unexpected<Error>(std::move(chosen.error()));
    ProgressBar bar(environment);
    bar.stage("read");
    Result<LoadedInput> input = loadInput(options.input, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    const Result<Comparison> comparison =
        compareAlgorithms({std::move(*input), std::move(*chosen), *target}, bar);
    if (!comparison)
        return tl::unexpected<Error>(comparison.error());
    bar.finish();
    if (!options.csv.empty())
        if (Result<void> written = writeFileText(options.csv, comparisonCsv(comparison->rows));
            !written)
            return written;
    environment.out << (options.json ? comparisonJson(comparison->original, comparison->rows)
                                     : comparisonTable(comparison->original, comparison->rows));
    return {};
}

ImageColumn column(const RunOutcome& outcome, std::uint64_t all_triangles) {
    const double share = 100.0 * static_cast<double>(outcome.lod->triangles) /
                         static_cast<double>(std::max<std::uint64_t>(all_triangles, 1));
    return {outcome.scene,
            outcome.lod,
            fmt::format("{}  {} tri  {:.1f} %  {}",
                        outcome.name,
                        thousands(outcome.lod->triangles),
                        share,
                        humanBytes(outcome.bytes))};
}

Result<LoadedInput> loadOrMake(const WindowRequest& request, const JobContext& job) {
    if (request.file)
        return loadInput(*request.file, job);
    Result<ScenePtr> maple = generateScene("maple");
    if (!maple)
        return tl::unexpected<Error>(std::move(maple.error()));
    return LoadedInput{std::move(*maple), 0.0};
}

Result<void> writeComparison(const WindowRequest& request, const CliEnvironment& environment) {
    constexpr double kFirstRatio = 0.2;
    ProgressBar bar(environment);
    bar.stage("read");
    Result<LoadedInput> input = loadOrMake(request, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    const auto chosen = algorithmsFromList("ias,quadric");
    if (!chosen)
        return tl::unexpected<Error>(chosen.error());
    const Result<Comparison> comparison = compareAlgorithms(
        {std::move(*input), *chosen, Target{Target::Kind::Ratio, kFirstRatio}}, bar);
    if (!comparison)
        return tl::unexpected<Error>(comparison.error());
    bar.finish();
    environment.out << comparisonTable(comparison->original, comparison->rows) << std::flush;

    RenderRequest picture;
    picture.path = "lodestone-comparison.png";
    picture.width_px = 640;
    picture.height_px = 640;
    const std::uint64_t all_triangles = comparison->original.lod->triangles;
    picture.columns.push_back(column(comparison->original, all_triangles));
    for (const RunOutcome& row : comparison->rows)
        picture.columns.push_back(column(row, all_triangles));
    if (!environment.images)
        return fail(ErrorKind::Failed, "this build draws no pictures; the table is complete");
    JobContext job;
    job.stop = environment.stop;
    const Result<RenderReport> report = environment.images->render(picture, job);
    if (!report)
        return tl::unexpected<Error>(report.error());
    environment.out << fmt::format("wrote {}\n", picture.path.string());
    return {};
}

} // namespace

void addCompareCommand(CLI::App& app, ChosenCommand& chosen) {
    const auto options = std::make_shared<CompareOptions>();
    CLI::App& command = *app.add_subcommand("compare", "run algorithms side by side");
    command.add_option("IN", options->input, "scene to read")->required();
    command
        .add_option("--algorithms",
                    options->algorithms,
                    "all, or ids separated by commas: " + algorithmIds())
        ->type_name("LIST");
    addTargetOptions(command, options->target);
    command.add_option("--csv", options->csv, "also write the rows to a file")->type_name("FILE");
    command.add_flag("--json", options->json, "one JSON object on stdout");
    addThreadsOption(command, chosen);
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runCompare(*options, environment);
        };
    });
}

int compareWithoutDisplay(const WindowRequest& request, const CliEnvironment& environment) {
    return finishCommand(writeComparison(request, environment), environment);
}

} // namespace lodestone
