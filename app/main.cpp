// The only file that knows every room: gives the command line its pixels and opens the window.
#include "app/cli.h"
#include "render/view.h"

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <numbers>
#include <thread>
#include <unistd.h>
#ifdef LODESTONE_WITH_WINDOW
#include <fontconfig/fontconfig.h>
#endif

namespace lodestone {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

// File of the system's sans-serif font, for labels below pictures; empty: no labels.
std::filesystem::path labelFont() {
#ifdef LODESTONE_WITH_WINDOW
    std::filesystem::path file;
    FcPattern* const pattern = FcNameParse(reinterpret_cast<const FcChar8*>("sans:style=Regular"));
    FcConfigSubstitute(nullptr, pattern, FcMatchPattern);
    FcDefaultSubstitute(pattern);
    FcResult matched = FcResultNoMatch;
    FcPattern* const font = FcFontMatch(nullptr, pattern, &matched);
    FcChar8* name = nullptr;
    if (font && FcPatternGetString(font, FC_FILE, 0, &name) == FcResultMatch)
        file = reinterpret_cast<const char*>(name);
    if (font)
        FcPatternDestroy(font);
    FcPatternDestroy(pattern);
    return file;
#else
    return {};
#endif
}

OrbitCamera cameraFor(const RenderRequest& request, const Bounds& bounds) {
    const double aspect = static_cast<double>(request.width_px) / request.height_px;
    if (request.file_camera)
        return cameraFromScene(request.columns[0].scene->cameras[*request.file_camera], bounds);
    OrbitCamera camera;
    if (request.orbit) {
        camera.azimuth_rad = request.orbit->azimuth_deg * kRadiansPerDegree;
        camera.elevation_rad = request.orbit->elevation_deg * kRadiansPerDegree;
    }
    frameCamera(camera, bounds, aspect);
    if (request.orbit && request.orbit->distance > 0.0)
        camera.distance = request.orbit->distance;
    return camera;
}

Shading shadingFor(ShadingMode mode) {
    switch (mode) {
    case ShadingMode::Lit:
        return Shading::Lit;
    case ShadingMode::Clay:
        return Shading::Clay;
    case ShadingMode::Normals:
        return Shading::Normals;
    case ShadingMode::Flat:
        return Shading::Flat;
    case ShadingMode::UvChecker:
        return Shading::UvChecker;
    case ShadingMode::Submesh:
        return Shading::BySubmesh;
    case ShadingMode::Instance:
        return Shading::ByInstance;
    }
    return Shading::Lit;
}

struct DrawnColumn {
    Pixels picture;
    double frame_ms = 0.0;
};

// Draws off screen with surfaceless EGL; the context lives for one request.
class HeadlessImages final : public ImageSource {
public:
    Result<RenderReport> render(const RenderRequest& request, const JobContext& job) override {
        auto context = createHeadlessContext();
        if (!context)
            return tl::unexpected<Error>(std::move(context.error()));
        const auto renderer = Renderer::create(**context);
        if (!renderer)
            return tl::unexpected<Error>(renderer.error());
        RenderReport report;
        report.renderer = (*context)->info().renderer;
        std::vector<SheetCell> cells;
        std::optional<OrbitCamera> camera;
        for (const ImageColumn& column : request.columns) {
            if (job.stopRequested())
                return cancelled();
            auto drawn = drawColumn(*renderer, request, column, camera);
            if (!drawn)
                return tl::unexpected<Error>(std::move(drawn.error()));
            if (request.measure)
                report.frame_ms.push_back(drawn->frame_ms);
            cells.push_back({std::move(drawn->picture), column.label});
            job.report(static_cast<double>(cells.size()) /
                       static_cast<double>(request.columns.size()));
        }
        return writePicture(request, cells, std::move(report));
    }

private:
    // camera: made for the first column, kept for the others.
    static Result<DrawnColumn> drawColumn(const Renderer& renderer,
                                          const RenderRequest& request,
                                          const ImageColumn& column,
                                          std::optional<OrbitCamera>& camera) {
        auto scene = GpuScene::create(renderer, column.scene);
        if (!scene)
            return tl::unexpected<Error>(std::move(scene.error()));
        LodHandle lod;
        if (const auto uploaded = scene->update(lod, *column.lod); !uploaded)
            return tl::unexpected<Error>(uploaded.error());
        auto view = View::create(renderer);
        if (!view)
            return tl::unexpected<Error>(std::move(view.error()));
        if (!camera)
            camera = cameraFor(request, scene->bounds());
        View::Input input;
        input.scene = &*scene;
        input.lod = &lod;
        input.camera = *camera;
        input.options.shading = shadingFor(request.shading);
        input.options.wireframe = request.wireframe;
        input.size = {static_cast<int>(request.width_px), static_cast<int>(request.height_px)};
        if (const auto drawn = view->draw(input); !drawn)
            return tl::unexpected<Error>(drawn.error());
        DrawnColumn result;
        if (request.measure) {
            constexpr double kMeasureBudget_s = 10.0; // software renderers need minutes otherwise
            const auto measured = view->measure(input, {100, 1000, kMeasureBudget_s});
            if (!measured)
                return tl::unexpected<Error>(measured.error());
            result.frame_ms = measured->mean_ms;
        }
        auto picture = view->readPixels();
        if (!picture)
            return tl::unexpected<Error>(std::move(picture.error()));
        result.picture = std::move(*picture);
        return result;
    }

    static Result<RenderReport> writePicture(const RenderRequest& request,
                                             const std::vector<SheetCell>& cells,
                                             RenderReport report) {
        Result<Pixels> sheet = cells[0].picture;
        if (cells.size() > 1) {
            SheetOptions options;
            options.font = labelFont();
            sheet = composeSheet(cells, options);
        }
        if (!sheet)
            return tl::unexpected<Error>(std::move(sheet.error()));
        if (const auto written = writePng(request.path, *sheet); !written)
            return tl::unexpected<Error>(written.error());
        report.width_px = sheet->width;
        report.height_px = sheet->height;
        return report;
    }
};

// Turns Ctrl+C and SIGTERM into a stop request; the second one ends the process at once. Made
// before any other thread, so that all of them inherit the blocked signals.
class SignalWatcher {
public:
    SignalWatcher() {
        sigemptyset(&signals_);
        sigaddset(&signals_, SIGINT);
        sigaddset(&signals_, SIGTERM);
        pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
        watcher_ = std::jthread(
            [signals = signals_, source = source_](const std::stop_token& finished) mutable {
                constexpr timespec kPatience{0, 50'000'000};
                while (!finished.stop_requested()) {
                    if (sigtimedwait(&signals, nullptr, &kPatience) < 0)
                        continue;
                    if (source.stop_requested())
                        _exit(exitCode(ErrorKind::Cancelled));
                    source.request_stop();
                }
            });
    }

    std::stop_token token() const { return source_.get_token(); }

private:
    sigset_t signals_{};
    std::stop_source source_;
    std::jthread watcher_;
};

std::string optionalParts() {
#ifdef LODESTONE_WITH_WINDOW
    return "window: GLFW, Dear ImGui; import: tinygltf, assimp; distance: Embree";
#else
    return "no window; import: tinygltf, assimp; distance: Embree";
#endif
}

int openWindow(const WindowRequest& request, const CliEnvironment& environment) {
    environment.err << "lodestone: no display; writing the comparison instead\n";
    return compareWithoutDisplay(request, environment);
}

int runProgram(int argc, char** argv) {
    const SignalWatcher signals;
    HeadlessImages images;
    const CliEnvironment environment{std::cout,
                                     std::cerr,
                                     &images,
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
