#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <fmt/core.h>
#include <ostream>

namespace lodestone {

namespace {

struct SimplifyOptions {
    std::string input;
    std::string output;
    std::string algorithm;
    TargetTexts target;
    std::vector<std::string> parameters;
    std::string ordering; // empty: what suits the target best
    std::string scope = "submesh";
    std::string instancing = "auto";
    std::string compress = "none";
    bool measure = false;
    bool json = false;
};

Result<ParameterValues> parseParameters(const Algorithm& algorithm,
                                        const std::vector<std::string>& texts) {
    ParameterValues values;
    for (const std::string& text : texts) {
        const auto assignment = parseAssignment(text);
        if (!assignment)
            return tl::unexpected<Error>(assignment.error());
        const Result<double> value =
            parseParameter(algorithm, assignment->first, assignment->second);
        if (!value)
            return tl::unexpected<Error>(value.error());
        values[assignment->first] = *value;
    }
    return values;
}

// Everything that can be wrong with the options, before the file is touched.
Result<RunRequest> parseRequest(const SimplifyOptions& options) {
    RunRequest request;
    const auto algorithm = algorithmFromId(options.algorithm);
    if (!algorithm)
        return tl::unexpected<Error>(algorithm.error());
    request.algorithm = *algorithm;
    const auto target = parseTarget(options.target);
    const auto parameters = parseParameters(**algorithm, options.parameters);
    const bool by_bytes = target && target->kind == Target::Kind::Bytes;
    const auto ordering = parseOrdering(!options.ordering.empty() ? options.ordering
                                        : by_bytes                ? "byte"
                                                                  : "triangle");
    const auto instancing = parseInstancing(options.instancing);
    const auto compression = parseCompression(options.compress);
    const auto output = checkOutput(options.output, exportExtensions());
    if (!target)
        return tl::unexpected<Error>(target.error());
    if (!parameters)
        return tl::unexpected<Error>(parameters.error());
    if (!ordering)
        return tl::unexpected<Error>(ordering.error());
    if (!instancing)
        return tl::unexpected<Error>(instancing.error());
    if (!compression)
        return tl::unexpected<Error>(compression.error());
    if (options.scope != "submesh" && options.scope != "expanded")
        return fail(ErrorKind::Usage,
                    fmt::format("--scope takes submesh or expanded, not '{}'", options.scope));
    if (!output)
        return tl::unexpected<Error>(output.error());
    request.target = *target;
    request.parameters = *parameters;
    request.schedule.ordering = *ordering;
    request.export_options.instancing = *instancing;
    request.export_options.compression = *compression;
    request.expand_first = options.scope == "expanded";
    return request;
}

Result<void>
writeOutcome(const RunRequest& request, const std::filesystem::path& path, RunOutcome& outcome) {
    const auto start = std::chrono::steady_clock::now();
    Result<ExportReport> report =
        exportScene(*outcome.scene, *outcome.lod, path, request.export_options);
    if (!report)
        return tl::unexpected<Error>(std::move(report.error()));
    outcome.seconds.write =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    outcome.bytes = report->bytes;
    for (std::string& note : report->notes)
        outcome.notes.push_back(std::move(note));
    return {};
}

Result<void> runSimplify(const SimplifyOptions& options, const CliEnvironment& environment) {
    Result<RunRequest> request = parseRequest(options);
    if (!request)
        return tl::unexpected<Error>(std::move(request.error()));
    std::error_code absent;
    if (std::filesystem::equivalent(options.input, options.output, absent))
        return fail(ErrorKind::Usage,
                    fmt::format("{}: is the input, too; write to another file", options.output));
    ProgressBar bar(environment);
    bar.stage("read");
    Result<LoadedInput> input = loadInput(options.input, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    request->scene = input->scene;
    bar.stage(fmt::format("simplify with {}", request->algorithm->id));
    Result<RunOutcome> outcome = runAlgorithm(*request, bar.context());
    if (!outcome)
        return tl::unexpected<Error>(std::move(outcome.error()));
    outcome->seconds.load = input->seconds;
    outcome->notes.insert(
        outcome->notes.begin(), input->scene->notes.begin(), input->scene->notes.end());
    if (environment.stop.stop_requested())
        return cancelled();
    bar.stage("write");
    if (Result<void> written = writeOutcome(*request, options.output, *outcome); !written)
        return written;
    if (options.measure) {
        bar.stage("measure");
        const Result<Distance> distance = measureFile(*input->scene, options.output, bar.context());
        if (!distance)
            return tl::unexpected<Error>(distance.error());
        outcome->distance = *distance;
    }
    bar.finish();
    environment.out << (options.json ? outcomeJson(*outcome)
                                     : outcomeText(*outcome, countScene(*input->scene)));
    return {};
}

} // namespace

void addSimplifyCommand(CLI::App& app, ChosenCommand& chosen) {
    const auto options = std::make_shared<SimplifyOptions>();
    CLI::App& command = *app.add_subcommand("simplify", "write one level of detail of a scene");
    command.add_option("IN", options->input, "scene to read")->required();
    command.add_option("-o,--output", options->output, "file to write: .glb or .gltf")
        ->required()
        ->type_name("OUT");
    command.add_option("--algorithm", options->algorithm, "one of " + algorithmIds())
        ->required()
        ->type_name("ID");
    addTargetOptions(command, options->target);
    addErrorTargetOption(command, options->target);
    command.add_option("--param", options->parameters, "option of the algorithm; may be repeated")
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->take_all();
    command
        .add_option("--ordering",
                    options->ordering,
                    "what a step is worth: cost | triangle | byte (default: byte for --bytes, else "
                    "triangle)")
        ->type_name("ORDER");
    command
        .add_option("--scope",
                    options->scope,
                    "submesh: keep instancing | expanded: every instance a mesh of its own first")
        ->type_name("SCOPE");
    command
        .add_option("--instancing",
                    options->instancing,
                    "in the file: auto (smaller) | nodes | gpu | expand")
        ->type_name("HOW");
    command
        .add_option("--compress",
                    options->compress,
                    "none | quantize (KHR_mesh_quantization) | meshopt "
                    "(EXT_meshopt_compression) | draco (KHR_draco_mesh_compression)")
        ->type_name("HOW");
    command.add_flag(
        "--measure", options->measure, "also measure how far what was written is from the input");
    command.add_flag("--json", options->json, "one JSON object on stdout");
    addThreadsOption(command, chosen);
    command.footer(parametersText());
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runSimplify(*options, environment);
        };
    });
}

} // namespace lodestone
