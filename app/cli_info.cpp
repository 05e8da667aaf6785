#include "app/cli_commands.h"
#include "app/cli_progress.h"
#include "app/cli_report.h"
#include "app/document.h"
#include "scene/gltf/source_document.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <ostream>

namespace lodestone {

namespace {

struct InfoOptions {
    std::string input;
    bool json = false;
};

std::size_t animationCount(const Scene& scene) {
    if (!scene.source)
        return 0;
    const auto found = scene.source->json.find("animations");
    return found != scene.source->json.end() && found->is_array() ? found->size() : 0;
}

std::string infoJson(const LoadedScene& loaded) {
    const Scene& scene = *loaded.scene;
    nlohmann::ordered_json json;
    json["submeshes"] = loaded.counts.submeshes;
    json["instances"] = loaded.counts.instances;
    json["triangles"] = loaded.counts.triangles;
    json["unique_triangles"] = loaded.counts.unique_triangles;
    json["vertices"] = loaded.counts.vertices;
    json["materials"] = scene.materials.size();
    json["images"] = scene.images.size();
    json["animations"] = animationCount(scene);
    json["bytes"] = scene.file_bytes;
    json["diagonal"] = loaded.bounds.diagonal();
    json["notes"] = scene.notes;
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string infoText(const LoadedScene& loaded) {
    const Scene& scene = *loaded.scene;
    const auto line = [](std::string_view name, const std::string& value) {
        return fmt::format("{:<18}{:>16}\n", name, value);
    };
    std::string text = fmt::format("{}\n", scene.name);
    text += line("submeshes", thousands(loaded.counts.submeshes));
    text += line("instances", thousands(loaded.counts.instances));
    text += line("triangles", thousands(loaded.counts.triangles));
    text += line("unique triangles", thousands(loaded.counts.unique_triangles));
    text += line("vertices", thousands(loaded.counts.vertices));
    text += line("materials", thousands(scene.materials.size()));
    text += line("images", thousands(scene.images.size()));
    text += line("animations", thousands(animationCount(scene)));
    text += line("size", humanBytes(scene.file_bytes));
    text += line("diagonal", fmt::format("{:.6g}", loaded.bounds.diagonal()));
    for (const std::string& note : scene.notes)
        text += fmt::format("note: {}\n", note);
    return text;
}

Result<void> runInfo(const InfoOptions& options, const CliEnvironment& environment) {
    ProgressBar bar(environment);
    bar.stage("read");
    Result<LoadedInput> input = loadInput(options.input, bar.context());
    if (!input)
        return tl::unexpected<Error>(std::move(input.error()));
    const LoadedScene loaded = describeScene(std::move(input->scene), options.input);
    environment.out << (options.json ? infoJson(loaded) : infoText(loaded));
    return {};
}

} // namespace

void addInfoCommand(CLI::App& app, ChosenCommand& chosen) {
    const auto options = std::make_shared<InfoOptions>();
    CLI::App& command = *app.add_subcommand("info", "what a file holds");
    command.add_option("FILE", options->input, "scene to read")->required();
    command.add_flag("--json", options->json, "one JSON object on stdout");
    addThreadsOption(command, chosen);
    command.callback([options, &chosen] {
        chosen.run = [options](const CliEnvironment& environment) {
            return runInfo(*options, environment);
        };
    });
}

} // namespace lodestone
