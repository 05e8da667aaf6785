#include "app/cli_commands.h"

#include "simplify/algorithm.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fmt/core.h>

namespace lodestone {

void addThreadsOption(CLI::App& command, ChosenCommand& chosen) {
    command.add_option("--threads", chosen.threads, "worker threads (default: all cores)")
        ->type_name("N");
}

void addTargetOptions(CLI::App& command, TargetTexts& texts) {
    command.add_option("--ratio", texts.ratio, "share of the instanced triangles to keep, 0..1")
        ->type_name("R");
    command.add_option("--triangles", texts.triangles, "instanced triangles to keep")
        ->type_name("N");
    command.add_option("--bytes", texts.bytes, "size of the written file")->type_name("B");
}

void addErrorTargetOption(CLI::App& command, TargetTexts& texts) {
    command.add_option("--error", texts.error, "estimated error in % of the diagonal, 0..100")
        ->type_name("PCT");
}

std::string algorithmIds() {
    std::string ids;
    for (const Algorithm& algorithm : algorithms())
        ids += (ids.empty() ? "" : ", ") + std::string(algorithm.id);
    return ids;
}

Result<const Algorithm*> algorithmFromId(std::string_view id) {
    if (const Algorithm* algorithm = findAlgorithm(id))
        return algorithm;
    return fail(ErrorKind::Usage,
                fmt::format("there is no algorithm '{}'; known are {}", id, algorithmIds()));
}

Result<std::vector<const Algorithm*>> algorithmsFromList(std::string_view list) {
    std::vector<const Algorithm*> chosen;
    if (list == "all") {
        for (const Algorithm& algorithm : algorithms())
            chosen.push_back(&algorithm);
        return chosen;
    }
    for (const std::string& id : splitList(list, ',')) {
        const Result<const Algorithm*> algorithm = algorithmFromId(id);
        if (!algorithm)
            return tl::unexpected<Error>(algorithm.error());
        chosen.push_back(*algorithm);
    }
    return chosen;
}

std::span<const std::string_view> exportExtensions() {
    static constexpr std::array<std::string_view, 2> kExtensions = {".glb", ".gltf"};
    return kExtensions;
}

Result<void> checkOutput(const std::filesystem::path& path,
                         std::span<const std::string_view> extensions) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    if (!extensions.empty() && std::ranges::find(extensions, extension) == extensions.end()) {
        std::string known;
        for (const std::string_view each : extensions)
            known += (known.empty() ? "" : " or ") + std::string(each);
        return fail(ErrorKind::Usage,
                    fmt::format("{}: the output must end in {}", path.string(), known));
    }
    std::error_code error;
    const std::filesystem::path folder =
        path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (!std::filesystem::is_directory(folder, error))
        return fail(ErrorKind::Failed,
                    fmt::format("{}: the folder does not exist; make it first", folder.string()));
    return {};
}

} // namespace lodestone
