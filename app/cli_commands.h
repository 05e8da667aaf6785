#pragma once
// The subcommands. Each adds its options to the parser and, when chosen, says what to run.
#include "app/cli.h"
#include "app/cli_values.h"

#include <functional>

namespace CLI { // NOLINT(readability-identifier-naming): the name of the library
class App;
} // namespace CLI

namespace lodestone {

struct Algorithm;

using CommandRun = std::function<Result<void>(const CliEnvironment&)>;

struct ChosenCommand {
    CommandRun run;      // set by the callback of the subcommand that was given
    std::string threads; // --threads, empty: all cores
};

void addInfoCommand(CLI::App& app, ChosenCommand& chosen);
void addSimplifyCommand(CLI::App& app, ChosenCommand& chosen);
void addCompareCommand(CLI::App& app, ChosenCommand& chosen);
void addDistanceCommand(CLI::App& app, ChosenCommand& chosen);
void addRenderCommand(CLI::App& app, ChosenCommand& chosen);
void addGenerateCommand(CLI::App& app, ChosenCommand& chosen);

// --- shared by the commands ---

void addThreadsOption(CLI::App& command, ChosenCommand& chosen);
// --ratio, --triangles, --bytes and, where it makes sense, --error.
void addTargetOptions(CLI::App& command, TargetTexts& texts);
void addErrorTargetOption(CLI::App& command, TargetTexts& texts);
// "ias, quadric, ...": ids of the table.
std::string algorithmIds();
// Usage error naming the known ones.
Result<const Algorithm*> algorithmFromId(std::string_view id);
// `all`, or ids separated by commas.
Result<std::vector<const Algorithm*>> algorithmsFromList(std::string_view list);
// An output that cannot work is refused before the long work: folder missing, extension not among
// `extensions` (lower case, with dot; none: any will do).
Result<void> checkOutput(const std::filesystem::path& path,
                         std::span<const std::string_view> extensions);
std::span<const std::string_view> exportExtensions(); // .glb .gltf
// Prints the error, if there is one, and gives the exit code.
int finishCommand(const Result<void>& result, const CliEnvironment& environment);

} // namespace lodestone
