#include "app/cli_commands.h"
#include "app/cli_report.h"
#include "app/file_text.h"
#include "app/report/comparison.h"
#include "app/report/comparison_text.h"
#include "app/report/html_page.h"
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
    std::string html;
    bool json = false;
};

Result<void> checkOutputs(const CompareOptions& options) {
    for (const std::string* path : {&options.csv, &options.html})
        if (!path->empty())
            if (Result<void> output = checkOutput(*path, {}); !output)
                return output;
    return {};
}

// Everything that can be wrong with the options, before the file is touched.
Result<ComparisonRequest> parseRequest(const CompareOptions& options) {
    const auto target = parseTarget(options.target);
    if (!target)
        return tl::unexpected<Error>(target.error());
    auto chosen = algorithmsFromList(options.algorithms);
    if (!chosen)
        return tl::unexpected<Error>(std::move(chosen.error()));
    if (Result<void> outputs = checkOutputs(options); !outputs)
        return tl::unexpected<Error>(std::move(outputs.error()));
    ComparisonRequest request;
    request.algorithms = std::move(*chosen);
    request.target = *target;
    if (!options.html.empty())
        request.depth = ComparisonRequest::Depth::Page;
    return request;
}

// One failed algorithm leaves the others' results standing, and is an error all the same.
Result<void> failedRows(const Comparison& comparison) {
    std::string failures;
    for (const ComparisonRow& row : comparison.rows)
        if (row.failed())
            failures +=
                fmt::format("{}{}: {}", failures.empty() ? "" : "; ", rowId(row), row.failure);
    if (failures.empty())
        return {};
    return fail(ErrorKind::Failed, failures + "; the other rows are complete");
}

Result<void> runCompare(const CompareOptions& options, const CliEnvironment& environment) {
    Result<ComparisonRequest> request = parseRequest(options);
    if (!request)
        return tl::unexpected<Error>(std::move(request.error()));
    ProgressBar bar(environment);
    bar.stage("read");
    Result<LoadedInput> input = loadInput(options.input, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    request->input = std::move(*input);
    const Result<Comparison> comparison = runComparison(*request, environment.images, bar);
    if (!comparison)
        return tl::unexpected<Error>(comparison.error());
    bar.finish();
    if (!options.csv.empty())
        if (Result<void> written = writeFileText(options.csv, comparisonCsv(*comparison)); !written)
            return written;
    if (!options.html.empty())
        if (Result<void> written = writeFileText(options.html, comparisonPage(*comparison));
            !written)
            return written;
    environment.out << (options.json ? comparisonJson(*comparison) : comparisonTable(*comparison));
    return failedRows(*comparison);
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

// The picture with the columns side by side.
Result<void> writeSheet(const Comparison& comparison, const CliEnvironment& environment) {
    RenderRequest picture;
    picture.path = "lodestone-comparison.png";
    picture.width_px = 640;
    picture.height_px = 640;
    const std::uint64_t all_triangles = comparison.original.outcome.lod->triangles;
    picture.columns.push_back(column(comparison.original.outcome, all_triangles));
    for (const ComparisonRow& row : comparison.rows)
        if (!row.failed())
            picture.columns.push_back(column(row.outcome, all_triangles));
    if (!environment.images)
        return fail(ErrorKind::Failed,
                    "this build draws no pictures; the table and the page are complete");
    JobContext job;
    job.stop = environment.stop;
    const Result<RenderReport> report = environment.images->render(picture, job);
    if (!report)
        return tl::unexpected<Error>(report.error());
    environment.out << fmt::format("wrote {}\n", picture.path.string());
    return {};
}

Result<void> writeComparison(const WindowRequest& request, const CliEnvironment& environment) {
    constexpr double kFirstRatio = 0.2;
    constexpr std::string_view kPage = "lodestone-comparison.html";
    ProgressBar bar(environment);
    bar.stage("read");
    Result<LoadedInput> input = loadOrMake(request, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    auto chosen = algorithmsFromList("ias,quadric");
    if (!chosen)
        return tl::unexpected<Error>(std::move(chosen.error()));
    const Result<Comparison> comparison = runComparison({std::move(*input),
                                                         std::move(*chosen),
                                                         {Target::Kind::Ratio, kFirstRatio},
                                                         ComparisonRequest::Depth::Page},
                                                        environment.images,
                                                        bar);
    if (!comparison)
        return tl::unexpected<Error>(comparison.error());
    bar.finish();
    environment.out << comparisonTable(*comparison) << std::flush;
    if (Result<void> page = writeFileText(kPage, comparisonPage(*comparison)); !page)
        return page;
    environment.out << fmt::format("wrote {}\n", kPage) << std::flush;
    if (Result<void> sheet = writeSheet(*comparison, environment); !sheet)
        return sheet;
    return failedRows(*comparison);
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
    command
        .add_option("--html",
                    options->html,
                    "also write a page with pictures, tables and charts: one file that needs "
                    "nothing else")
        ->type_name("FILE");
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
