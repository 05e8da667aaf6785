#pragma once
// The program with a window.
#include "app/cli.h"

namespace lodestone {

// Opens the window and returns once it is closed: the exit code. Without a display it says so and
// writes the comparison instead. Main thread.
int openWindow(const WindowRequest& request, const CliEnvironment& environment);

} // namespace lodestone
