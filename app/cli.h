#pragma once
// The command line: parses, runs a command, or says that the window is wanted.
#include "app/image_source.h"

#include <iosfwd>

namespace lodestone {

struct CliEnvironment {
    std::ostream& out;             // results; with --json one object and nothing else
    std::ostream& err;             // messages and the progress bar
    ImageSource* images = nullptr; // null: `render` fails with a message
    std::stop_token stop;          // Ctrl+C
    bool show_progress = false;    // err is a terminal
    std::string optional_parts;    // "window, tests": what --version names besides the version
};

struct WindowRequest {
    std::optional<std::filesystem::path> file; // none: the built-in maple tree
};

struct CliOutcome {
    int exit_code = 0;
    std::optional<WindowRequest> window; // open the window instead; nothing was run
};

// argv as in main. Exit codes: 0 done, 1 failed, 2 wrong usage, 3 bad input, 130 interrupted.
// Every error is one line on err: "lodestone: ...". Throws nothing.
CliOutcome runCommandLine(int argc, const char* const* argv, const CliEnvironment& environment);

// What the window command does without a display: writes lodestone-comparison.png into the working
// directory and prints the comparison table of the file, or of the maple tree. Returns an exit
// code.
int compareWithoutDisplay(const WindowRequest& request, const CliEnvironment& environment);

} // namespace lodestone
