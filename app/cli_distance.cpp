#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"
#include "app/image_measure.h"
#include "simplify/measure/color_distance.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <ostream>

namespace lodestone {

namespace {

struct DistanceCommandOptions {
    std::string a;
    std::string b;
    std::string samples;
    bool images = false;
    bool color = false;
    bool json = false;
};

// What was measured; the optional ones only if asked for.
struct Measured {
    Distance distance;
    std::optional<ImageDifference> image;
    std::optional<ColorDistance> color;
};

struct DistanceInput {
    LoadedInput a;
    LoadedInput b;
    std::shared_ptr<const Lod> lod_a;
    std::shared_ptr<const Lod> lod_b;
    DistanceOptions options;
};

Result<DistanceInput> loadBoth(const DistanceCommandOptions& options, const JobContext& job) {
    Result<LoadedInput> a = loadInput(options.a, job);
    if (!a)
        return tl::unexpected<Error>(std::move(a.error()));
    Result<LoadedInput> b = loadInput(options.b, job);
    if (!b)
        return tl::unexpected<Error>(std::move(b.error()));
    DistanceInput input{std::move(*a), std::move(*b), nullptr, nullptr, {}};
    input.lod_a = std::make_shared<const Lod>(fullLod(*input.a.scene));
    input.lod_b = std::make_shared<const Lod>(fullLod(*input.b.scene));
    return input;
}

Result<ImageDifference>
measureBothImages(const DistanceInput& input, ImageSource* images, const JobContext& job) {
    if (!images)
        return fail(ErrorKind::Failed, "this build draws no pictures; leave out --images");
    const std::array<ImageColumn, 2> columns = {
        {{input.a.scene, input.lod_a, ""}, {input.b.scene, input.lod_b, ""}}};
    Result<std::vector<ImageDifference>> differences = measureImages(*images, columns, {}, job);
    if (!differences)
        return tl::unexpected<Error>(std::move(differences.error()));
    return differences->front();
}

Result<Measured> measureBoth(const DistanceInput& input,
                             const DistanceCommandOptions& options,
                             ProgressBar& bar,
                             ImageSource* images) {
    const LodView a{input.a.scene.get(), input.lod_a.get()};
    const LodView b{input.b.scene.get(), input.lod_b.get()};
    Measured measured;
    bar.stage("measure");
    Result<Distance> distance = measureDistance(a, b, input.options, bar.context());
    if (!distance)
        return tl::unexpected<Error>(std::move(distance.error()));
    measured.distance = *distance;
    if (options.color) {
        bar.stage("compare colours");
        Result<ColorDistance> color = measureColorDistance(a, b, input.options, bar.context());
        if (!color)
            return tl::unexpected<Error>(std::move(color.error()));
        measured.color = std::move(*color);
    }
    if (options.images) {
        bar.stage("compare pictures");
        Result<ImageDifference> image = measureBothImages(input, images, bar.context());
        if (!image)
            return tl::unexpected<Error>(std::move(image.error()));
        measured.image = *image;
    }
    return measured;
}

std::string measuredJson(const Measured& measured) {
    nlohmann::json json = nlohmann::json::parse(distanceJson(measured.distance));
    if (const auto& image = measured.image) {
        json["image"] = {{"flip", image->flip}, {"ssim", image->ssim}, {"cameras", image->cameras}};
        json["image"]["psnr"] =
            std::isinf(image->psnr_db) ? nlohmann::json() : nlohmann::json(image->psnr_db);
    }
    if (const auto& color = measured.color)
        json["colour"] = {{"mean", color->mean},
                          {"a_to_b", color->a_to_b},
                          {"b_to_a", color->b_to_a},
                          {"samples", color->samples},
                          {"notes", color->notes}};
    return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string measuredText(const Measured& measured) {
    std::string text = distanceText(measured.distance);
    if (const auto& color = measured.color) {
        text += fmt::format("colour distance of closest points, RGB 0..1: mean {:.6g} ({:.6g} from "
                            "A to B, {:.6g} from B to A)\n",
                            color->mean,
                            color->a_to_b,
                            color->b_to_a);
        for (const std::string& note : color->notes)
            text += fmt::format("note: {}\n", note);
    }
    if (const auto& image = measured.image)
        text += fmt::format("pictures from {} cameras: FLIP {:.6g}, SSIM {:.6g}, PSNR {}\n",
                            image->cameras,
                            image->flip,
                            image->ssim,
                            std::isinf(image->psnr_db) ? "infinite"
                                                       : fmt::format("{:.4g} dB", image->psnr_db));
    return text;
}

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
    Result<DistanceInput> input = loadBoth(options, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    input->options = distance_options;
    const Result<Measured> measured = measureBoth(*input, options, bar, environment.images);
    if (!measured)
        return tl::unexpected<Error>(measured.error());
    bar.finish();
    environment.out << (options.json ? measuredJson(*measured) : measuredText(*measured));
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
    command.add_flag(
        "--images", options->images, "also compare pictures from 12 cameras: FLIP, SSIM, PSNR");
    command.add_flag(
        "--colour,--color", options->color, "also compare the base colour of closest points");
    command.add_flag("--json", options->json, "one JSON object on stdout");
    addThreadsOption(command, chosen);
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runDistance(*options, environment);
        };
    });
}

} // namespace lodestone
