// Where the program starts. It and the files in app/main/ are the only ones that know every room:
// they give the command line its pixels and open the window.
#include "app/cli.h"
#include "app/log.h"
#include "app/main/headless_images.h"
#include "app/signals.h"
#include "simplify/pointcloud/advancing_front.h"
#ifdef LODESTONE_WITH_WINDOW
#include "app/main/window_loop.h"
#endif

#include <iostream>
#include <unistd.h>

namespace lodestone {

namespace {

std::string optionalParts() {
#ifdef LODESTONE_WITH_WINDOW
    std::string parts = "window: GLFW, Dear ImGui";
#else
    std::string parts = "no window";
#endif
    parts += "; import: tinygltf, Draco, meshoptimizer, assimp; images: stb, libwebp; distance: "
             "Embree; surfaces from points: ";
    return parts + (canRebuildFromPoints() ? "CGAL (GPL-3)" : "none");
}

#ifndef LODESTONE_WITH_WINDOW

int openWindow(const WindowRequest& request, const CliEnvironment& environment) {
    environment.err << "lodestone: built without a window; writing the comparison instead\n";
    return compareWithoutDisplay(request, environment);
}

#endif

int runProgram(int argc, char** argv) {
    logToStderr();
    const SignalWatcher signals;
    const std::unique_ptr<ImageSource> images = makeHeadlessImages();
    const CliEnvironment environment{std::cout,
                                     std::cerr,
                                     images.get(),
                                     signals.token(),
                                     isatty(STDERR_FILENO) == 1,
                                     optionalParts()};
    const CliOutcome outcome = runCommandLine(argc, argv, environment);
    return outcome.window ? openWindow(*outcome.window, environment) : outcome.exit_code;
}

} // namespace

} // namespace lodestone

int main(int argc, char** argv) {
    try {
        return lodestone::runProgram(argc, argv);
    } catch (const std::exception& exception) {
        std::cerr << "lodestone: " << exception.what() << '\n';
        return lodestone::exitCode(lodestone::ErrorKind::Failed);
    }
}
