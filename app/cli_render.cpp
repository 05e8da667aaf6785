#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"

#include <CLI/CLI.hpp>
#include <array>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <ostream>

namespace lodestone {

namespace {

struct RenderOptions {
    std::string input;
    std::string output;
    std::string size = "1280x720";
    std::string camera;
    std::string file_camera;
    std::string shading = "lit";
    std::string animation;
    std::string time;
    std::string compare; // ids; empty: the file itself
    TargetTexts target;
    bool wireframe = false;
    bool measure = false;
    bool json = false;
};

struct ParsedRender {
    RenderRequest request;
    std::vector<const Algorithm*> columns; // nullptr: the original
    Target target;
};

std::string shadingList() {
    std::string names;
    for (std::size_t index = 0; index < kShadingModes; ++index)
        names +=
            (index == 0 ? "" : ", ") + std::string(shadingName(static_cast<ShadingMode>(index)));
    return names;
}

Result<void> parseColumns(const RenderOptions& options, ParsedRender& parsed) {
    const TargetTexts& texts = options.target;
    const bool has_target = !texts.ratio.empty() || !texts.triangles.empty() ||
                            !texts.bytes.empty() || !texts.error.empty();
    if (options.compare.empty()) {
        if (has_target)
            return fail(ErrorKind::Usage, "a target needs --compare with the algorithms to draw");
        parsed.columns.push_back(nullptr);
        return {};
    }
    const auto target = parseTarget(texts);
    if (!target)
        return tl::unexpected<Error>(target.error());
    parsed.target = *target;
    for (const std::string& id : splitList(options.compare, ',')) {
        if (id == "original") {
            parsed.columns.push_back(nullptr);
            continue;
        }
        const auto algorithm = algorithmFromId(id);
        if (!algorithm)
            return tl::unexpected<Error>(algorithm.error());
        parsed.columns.push_back(*algorithm);
    }
    return {};
}

Result<void> parseView(const RenderOptions& options, RenderRequest& request) {
    constexpr std::uint64_t kMostCameras = 1'000'000;
    const auto size = parseSize(options.size);
    if (!size)
        return tl::unexpected<Error>(size.error());
    request.width_px = size->width_px;
    request.height_px = size->height_px;
    const auto shading = shadingFromName(options.shading);
    if (!shading)
        return fail(ErrorKind::Usage,
                    fmt::format("--shading takes {}, not '{}'", shadingList(), options.shading));
    request.shading = *shading;
    request.wireframe = options.wireframe;
    request.measure = options.measure;
    if (!options.camera.empty() && !options.file_camera.empty())
        return fail(ErrorKind::Usage, "give --camera or --file-camera, not both");
    if (!options.camera.empty()) {
        const auto orbit = parseCamera(options.camera);
        if (!orbit)
            return tl::unexpected<Error>(orbit.error());
        request.orbit = *orbit;
    }
    if (!options.file_camera.empty()) {
        const auto index = parseCount("--file-camera", options.file_camera, 0, kMostCameras);
        if (!index)
            return tl::unexpected<Error>(index.error());
        request.file_camera = static_cast<std::uint32_t>(*index);
    }
    return {};
}

Result<void> parseMoment(const RenderOptions& options, RenderRequest& request) {
    constexpr std::uint64_t kMostAnimations = 1'000'000;
    constexpr double kLongestSeconds = 1e9;
    if (options.animation.empty() && !options.time.empty())
        return fail(ErrorKind::Usage,
                    "--time needs --animation with the animation it is a time of");
    if (options.animation.empty())
        return {};
    const auto index = parseCount("--animation", options.animation, 0, kMostAnimations);
    if (!index)
        return tl::unexpected<Error>(index.error());
    request.moment.animation = static_cast<std::uint32_t>(*index);
    if (options.time.empty())
        return {};
    const auto time = parseNumber("--time", options.time, 0.0, kLongestSeconds);
    if (!time)
        return tl::unexpected<Error>(time.error());
    request.moment.time_s = *time;
    return {};
}

// What the options name is in the file.
Result<void>
checkNamed(const RenderOptions& options, const RenderRequest& request, const Scene& scene) {
    if (request.file_camera && *request.file_camera >= scene.cameras.size())
        return fail(ErrorKind::Usage,
                    fmt::format("--file-camera {}: {} has {} cameras, counted from 0",
                                *request.file_camera,
                                options.input,
                                scene.cameras.size()));
    if (request.moment.animation == kNone)
        return {};
    const std::size_t animations = readRig(scene)->animations.size();
    if (request.moment.animation >= animations)
        return fail(ErrorKind::Usage,
                    fmt::format("--animation {}: {} has {} animations, counted from 0",
                                request.moment.animation,
                                options.input,
                                animations));
    return {};
}

Result<ParsedRender> parseRender(const RenderOptions& options) {
    static constexpr std::array<std::string_view, 1> kPictures = {".png"};
    ParsedRender parsed;
    parsed.request.path = options.output;
    if (Result<void> view = parseView(options, parsed.request); !view)
        return tl::unexpected<Error>(std::move(view.error()));
    if (Result<void> moment = parseMoment(options, parsed.request); !moment)
        return tl::unexpected<Error>(std::move(moment.error()));
    if (Result<void> columns = parseColumns(options, parsed); !columns)
        return tl::unexpected<Error>(std::move(columns.error()));
    if (Result<void> output = checkOutput(options.output, kPictures); !output)
        return tl::unexpected<Error>(std::move(output.error()));
    return parsed;
}

// Runs the columns' algorithms; each outcome becomes a column of the picture.
Result<std::vector<RunOutcome>>
runColumns(ParsedRender& parsed, const ScenePtr& scene, ProgressBar& bar) {
    std::vector<RunOutcome> outcomes;
    RunRequest run;
    run.scene = scene;
    run.target = parsed.target;
    const double all =
        static_cast<double>(std::max<std::uint64_t>(countScene(*scene).triangles, 1));
    for (const Algorithm* algorithm : parsed.columns) {
        run.algorithm = algorithm;
        bar.stage(fmt::format("simplify with {}", algorithm ? algorithm->id : "original"));
        Result<RunOutcome> outcome = runAlgorithm(run, bar.context());
        if (!outcome)
            return tl::unexpected<Error>(std::move(outcome.error()));
        const double share = 100.0 * static_cast<double>(outcome->lod->triangles) / all;
        parsed.request.columns.push_back({outcome->scene,
                                          outcome->lod,
                                          parsed.columns.size() == 1
                                              ? std::string()
                                              : fmt::format("{}  {:.1f} %  {} tri",
                                                            outcome->name,
                                                            share,
                                                            thousands(outcome->lod->triangles))});
        outcomes.push_back(std::move(*outcome));
    }
    return outcomes;
}

std::string renderJson(const std::vector<RunOutcome>& outcomes, const RenderReport& report) {
    nlohmann::ordered_json json;
    json["width"] = report.width_px;
    json["height"] = report.height_px;
    json["renderer"] = report.renderer;
    json["columns"] = nlohmann::ordered_json::array();
    for (std::size_t index = 0; index < outcomes.size(); ++index) {
        nlohmann::ordered_json column;
        column["algorithm"] = outcomes[index].algorithm;
        column["triangles"] = outcomes[index].lod->triangles;
        if (index < report.frame_ms.size())
            column["frame_ms"] = report.frame_ms[index];
        json["columns"].push_back(std::move(column));
    }
    return json.dump(2) + "\n";
}

std::string renderText(const std::vector<RunOutcome>& outcomes, const RenderReport& report) {
    std::string text;
    for (std::size_t index = 0; index < report.frame_ms.size() && index < outcomes.size(); ++index)
        text += fmt::format("{:<16}{:>12} triangles{:>10.3f} ms{:>10.1f} fps\n",
                            outcomes[index].algorithm,
                            thousands(outcomes[index].lod->triangles),
                            report.frame_ms[index],
                            1000.0 / std::max(report.frame_ms[index], 1e-6));
    return text +
           fmt::format("{} x {} px, {}\n", report.width_px, report.height_px, report.renderer);
}

Result<void> runRender(const RenderOptions& options, const CliEnvironment& environment) {
    Result<ParsedRender> parsed = parseRender(options);
    if (!parsed)
        return tl::unexpected<Error>(std::move(parsed.error()));
    if (!environment.images)
        return fail(ErrorKind::Failed, "this build draws no pictures");
    ProgressBar bar(environment);
    bar.stage("read");
    const Result<LoadedInput> input = loadInput(options.input, bar.context());
    if (!input)
        return tl::unexpected<Error>(input.error());
    const RenderRequest& request = parsed->request;
    if (Result<void> named = checkNamed(options, request, *input->scene); !named)
        return tl::unexpected<Error>(std::move(named.error()));
    const auto outcomes = runColumns(*parsed, input->scene, bar);
    if (!outcomes)
        return tl::unexpected<Error>(outcomes.error());
    bar.stage("draw");
    const Result<RenderReport> report = environment.images->render(request, bar.context());
    if (!report)
        return tl::unexpected<Error>(report.error());
    bar.finish();
    environment.out << (options.json ? renderJson(*outcomes, *report)
                                     : renderText(*outcomes, *report));
    return {};
}

} // namespace

void addRenderCommand(CLI::App& app, ChosenCommand& chosen) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App& command = *app.add_subcommand("render", "draw a scene, or levels of detail, as PNG");
    command.add_option("IN", options->input, "scene to read")->required();
    command.add_option("-o,--output", options->output, "picture to write: .png")
        ->required()
        ->type_name("PNG");
    command.add_option("--size", options->size, "of one column in pixels (default 1280x720)")
        ->type_name("WxH");
    command
        .add_option("--camera",
                    options->camera,
                    "degrees around, degrees up, distance from the centre in scene units (0: fit)")
        ->type_name("AZ,EL,DIST");
    command.add_option("--file-camera", options->file_camera, "a camera of the file, from 0")
        ->type_name("INDEX");
    command.add_option("--shading", options->shading, "one of " + shadingList())->type_name("MODE");
    command.add_option("--animation", options->animation, "of the file, from 0 (default: at rest)")
        ->type_name("INDEX");
    command.add_option("--time", options->time, "seconds into the animation (default 0)")
        ->type_name("S");
    command.add_flag("--wireframe", options->wireframe, "edges over the shading");
    command
        .add_option("--compare",
                    options->compare,
                    "columns: ids separated by commas, `original` among them; needs a target")
        ->type_name("ID,ID");
    addTargetOptions(command, options->target);
    addErrorTargetOption(command, options->target);
    command.add_flag("--measure", options->measure, "also time each column");
    command.add_flag("--json", options->json, "one JSON object on stdout");
    addThreadsOption(command, chosen);
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runRender(*options, environment);
        };
    });
}

} // namespace lodestone
