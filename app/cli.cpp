#include "app/cli.h"

#include "app/cli_commands.h"
#include "app/cli_report.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fmt/core.h>
#include <ostream>
#include <tbb/global_control.h>

namespace lodestone {

namespace {

struct TopLevel {
    std::string file;
    bool version = false;
    bool list_algorithms = false;
    bool json = false;
};

std::string oneLine(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.'))
        text.pop_back();
    return text;
}

int usageError(const std::string& message, const CliEnvironment& environment) {
    return finishCommand(fail(ErrorKind::Usage, message + "; see --help"), environment);
}

// A mistyped command comes as the file to open.
bool isMistyped(const std::string& file) {
    std::error_code error;
    const std::filesystem::path path(file);
    return !file.empty() && !path.has_extension() && !std::filesystem::exists(path, error);
}

std::string mistyped(const std::string& file) {
    return fmt::format("'{}' is neither a command nor a file", file);
}

void addTopLevel(CLI::App& app, TopLevel& top, ChosenCommand& chosen) {
    app.add_option("FILE", top.file, "scene to open in the window (none: a built-in maple tree)");
    app.add_flag("--version", top.version, "version and optional parts");
    app.add_flag("--list-algorithms", top.list_algorithms, "the table of algorithms");
    app.add_flag("--json", top.json, "with --list-algorithms: one JSON object on stdout");
    addThreadsOption(app, chosen);
    app.require_subcommand(0, 1);
    app.footer("lodestone COMMAND --help explains a command.");
    addInfoCommand(app, chosen);
    addSimplifyCommand(app, chosen);
    addCompareCommand(app, chosen);
    addDistanceCommand(app, chosen);
    addRenderCommand(app, chosen);
    addGenerateCommand(app, chosen);
}

std::string helpText(const CLI::App& app) {
    const std::vector<const CLI::App*> subcommands =
        app.get_subcommands([](const CLI::App*) { return true; });
    for (const CLI::App* command : subcommands)
        if (command->parsed())
            return command->help(app.get_name());
    return app.help();
}

Result<std::unique_ptr<tbb::global_control>> limitThreads(const std::string& text) {
    constexpr std::uint64_t kMostThreads = 1024;
    if (text.empty())
        return nullptr;
    const auto threads = parseCount("--threads", text, 1, kMostThreads);
    if (!threads)
        return tl::unexpected<Error>(threads.error());
    return std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                 static_cast<std::size_t>(*threads));
}

Result<void> runGuarded(const CommandRun& run, const CliEnvironment& environment) {
    try {
        return run(environment);
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::Failed, "not enough memory; close other programs or simplify less");
    } catch (const std::exception& exception) {
        return fail(ErrorKind::Failed, oneLine(exception.what()));
    }
}

CliOutcome
runTopLevel(const TopLevel& top, const ChosenCommand& chosen, const CliEnvironment& environment) {
    if (top.version) {
        environment.out << fmt::format(
            "lodestone {} ({})\n", LODESTONE_VERSION, environment.optional_parts);
        return {};
    }
    if (top.list_algorithms) {
        environment.out << (top.json ? algorithmsJson() : algorithmsText());
        return {};
    }
    if (top.json)
        return {usageError("--json needs a command or --list-algorithms", environment), {}};
    const auto threads = limitThreads(chosen.threads);
    if (!threads)
        return {finishCommand(tl::unexpected<Error>(threads.error()), environment), {}};
    if (chosen.run)
        return {finishCommand(runGuarded(chosen.run, environment), environment), {}};
    if (isMistyped(top.file))
        return {usageError(mistyped(top.file), environment), {}};
    CliOutcome outcome;
    outcome.window.emplace();
    if (!top.file.empty())
        outcome.window->file = top.file;
    return outcome;
}

} // namespace

int finishCommand(const Result<void>& result, const CliEnvironment& environment) {
    environment.out << std::flush;
    if (!result) {
        environment.err << fmt::format("lodestone: {}\n", oneLine(result.error().message))
                        << std::flush;
        return exitCode(result.error().kind);
    }
    if (environment.out)
        return 0;
    environment.err << "lodestone: the output cannot be written; is the disk full?\n";
    return exitCode(ErrorKind::Failed);
}

CliOutcome runCommandLine(int argc, const char* const* argv, const CliEnvironment& environment) {
    CLI::App app("Levels of detail of instanced scenes: the window, and commands for pipelines",
                 "lodestone");
    TopLevel top;
    ChosenCommand chosen;
    addTopLevel(app, top, chosen);
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        environment.out << helpText(app) << std::flush;
        return {};
    } catch (const CLI::ParseError& error) {
        const std::string what = isMistyped(top.file) ? mistyped(top.file) : oneLine(error.what());
        return {usageError(what, environment), {}};
    }
    return runTopLevel(top, chosen, environment);
}

} // namespace lodestone
