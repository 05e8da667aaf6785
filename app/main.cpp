// The only file that knows every room: gives the command line its pixels and opens the window.
#include "app/cli.h"
#include "app/signals.h"
#include "render/view.h"
#ifdef LODESTONE_WITH_WINDOW
#include "app/drafts.h"
#include "app/frame_times.h"
#include "app/session.h"
#include "render/view_set.h"
#include "ui/fonts.h"
#include "ui/host.h"
#include "ui/window.h"
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <numbers>
#include <unistd.h>

namespace lodestone {

namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

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
            constexpr double kMeasureBudgetSeconds =
                10.0; // software renderers need minutes otherwise
            const auto measured = view->measure(input, {100, 1000, kMeasureBudgetSeconds});
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
#ifdef LODESTONE_WITH_WINDOW
            options.font = ui::systemFontFile();
#endif
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

std::string optionalParts() {
#ifdef LODESTONE_WITH_WINDOW
    return "window: GLFW, Dear ImGui; import: tinygltf, assimp; distance: Embree";
#else
    return "no window; import: tinygltf, assimp; distance: Embree";
#endif
}

#ifdef LODESTONE_WITH_WINDOW

// The shorter side of the picture spans kVerticalFovRad, so that tall pictures cut nothing off.
OrbitCamera orbitCamera(const CameraState& state, const Bounds& bounds, double aspect) {
    OrbitCamera camera;
    camera.target = state.target;
    camera.distance = state.distance;
    camera.azimuth_rad = state.azimuth_deg * kRadiansPerDegree;
    camera.elevation_rad = state.elevation_deg * kRadiansPerDegree;
    camera.orthographic = state.orthographic;
    camera.yfov_rad = 2.0 * std::atan(std::tan(kVerticalFovRad * 0.5) / std::min(1.0, aspect));
    if (!bounds.empty) {
        camera.scene_center = bounds.center();
        camera.scene_radius = bounds.diagonal() * 0.5;
    }
    return camera;
}

ViewOptions viewOptions(const DisplayOptions& display) {
    ViewOptions options;
    options.shading = shadingFor(display.shading);
    options.wireframe = display.wireframe;
    options.background = Background::Solid;
    options.light_azimuth_rad = static_cast<float>(-display.light_azimuth_deg * kRadiansPerDegree);
    options.light_elevation_rad =
        static_cast<float>(display.light_elevation_deg * kRadiansPerDegree);
    return options;
}

// The window's loop: events, commands, session, pictures, interface. Sleeps while nothing changes.
class WindowLoop {
public:
    WindowLoop(GlContext& context,
               const Renderer& renderer,
               Session& session,
               const WindowRequest& request)
        : context_(context), session_(session), pictures_(renderer),
          drafts_(context.info().is_software ? kSoftwareMsPerTriangle : 0.0),
          host_(context.nativeWindow()),
          window_(session, host_.theme(), {.welcome = !request.file}) {
        session_.setFraming([this](const Document& document, const Bounds& part) {
            return framedCamera(document, part);
        });
        facts_.renderer = shortRendererName(context.info().renderer);
        if (request.file)
            commands_.push(OpenScene{*request.file});
        else
            commands_.push(OpenSample{"maple", 1});
    }

    void run(const std::stop_token& stop) {
        while (!window_.wantsToQuit() && !stop.stop_requested()) {
            if (host_.waitEvents(waitTime()))
                settle_ = kSettlePasses;
            begun_ = Clock::now();
            window_.drop(host_.takeDroppedFiles(), commands_);
            if (host_.takeCloseRequest())
                window_.askToQuit();
            if (session_.update(commands_))
                settle_ = std::max(settle_, 1);
            const bool due = std::chrono::steady_clock::now() >= wake_at_;
            if (!host_.minimised() && (settle_ > 0 || stale_ || due))
                drawFrame();
        }
    }

private:
    using Clock = std::chrono::steady_clock;

    static constexpr int kSettlePasses = 3; // frames until hovering and layout have settled
    static constexpr double kPictureBudgetMs = 25.0;
    static constexpr double kSoftwareMsPerTriangle = 0.0002; // llvmpipe on two cores
    static constexpr std::chrono::milliseconds kRest{150};   // no input for so long: refine
    static constexpr double kLongestWaitSeconds = 0.5;       // finished jobs are noticed within it

    // "llvmpipe" of "llvmpipe (LLVM 15.0.6, 256 bits)".
    static std::string shortRendererName(const std::string& renderer) {
        return renderer.substr(0, renderer.find(" ("));
    }

    double waitTime() const {
        if (settle_ > 0 || stale_)
            return 0.0;
        const std::chrono::duration<double> left = wake_at_ - Clock::now();
        const double longest = session_.document().jobs.empty() ? kLongestWaitSeconds : 1.0 / 30.0;
        return std::clamp(left.count(), 0.001, longest);
    }

    void drawFrame() {
        settle_ = std::max(0, settle_ - 1);
        facts_.width_px = host_.widthPx();
        facts_.height_px = host_.heightPx();
        facts_.density = host_.density();
        host_.beginPass();
        window_.draw(facts_, shown_, commands_);
        bool again = session_.update(commands_);
        const Document& document = session_.document();
        if (document.scene && document.camera.distance <= 0.0) {
            commands_.push(FrameScene{});
            again = session_.update(commands_) || again;
        }
        again = drawPictures() || again;
        if (again) { // numbers and pictures of this frame, not of the last one
            host_.discardPass();
            host_.beginPass();
            window_.draw(facts_, shown_, commands_);
        }
        clearWindow(
            {facts_.width_px, facts_.height_px, 0x14 / 255.0f, 0x17 / 255.0f, 0x1b / 255.0f});
        host_.endFrame();
        context_.swapBuffers();
        finishFrame();
    }

    void finishFrame() {
        session_.uiLog().frame(++facts_.frame);
        logPictures();
        const std::chrono::duration<double, std::milli> time = Clock::now() - begun_;
        if (const auto told = frame_times_.add(Clock::now(), time.count()))
            session_.uiLog().object("frames", "frames", *told);
        if (!commands_.empty())
            settle_ = std::max(settle_, 2);
        const double wake_s = std::min(window_.wakeIn(), 3600.0);
        wake_at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(wake_s));
        for (const auto& [lane, rests_at] : rests_at_)
            if (shows_draft_ && rests_at > begun_)
                wake_at_ = std::min(wake_at_, rests_at);
        if (window_.takeFullScreenToggle())
            host_.toggleFullScreen();
        const Document& document = session_.document();
        host_.setTitle(document.scene ? document.scene->name + " \u2013 Lodestone" : "Lodestone");
    }

    // For tests: whether every view shows what it should.
    void logPictures() {
        const bool drawn = !shown_.empty() && std::ranges::all_of(shown_, [](const auto& picture) {
            return picture.texture != nullptr && !picture.draft;
        });
        const bool final = drawn && session_.document().jobs.empty();
        session_.uiLog().object(
            "pictures", "pictures", final ? "\"final\":true" : "\"final\":false");
    }

    // Returns whether any picture is another than before.
    bool drawPictures() {
        const Document& document = session_.document();
        noteMotion(document);
        const Clock::time_point now = Clock::now();
        std::vector<ViewSet::Wanted> wanted;
        for (const ui::ViewRequest& view : window_.views()) {
            const Lane* const lane = document.findLane(view.lane);
            if (lane)
                wanted.push_back(
                    {view.lane,
                     lane->status.scene,
                     lane->status.lod,
                     now < rests_at_[lane->id] ? drafts_.draftOf(document, *lane) : nullptr,
                     {view.width_px, view.height_px}});
        }
        const auto drawn =
            pictures_.draw(wanted,
                           orbitCamera(document.camera, document.bounds, viewAspect()),
                           viewOptions(document.view),
                           kPictureBudgetMs);
        if (!drawn) {
            session_.reportError(drawn.error().message); // repeats are counted, not listed again
            return false;
        }
        return takePictures(*drawn);
    }

    double viewAspect() const {
        if (window_.views().empty())
            return 1.0;
        const ui::ViewRequest& view = window_.views().front();
        return ViewSize{view.width_px, view.height_px}.aspect();
    }

    // Lanes whose picture becomes another one rest a moment later: all of them when the camera or
    // the display changes, else those whose LOD does.
    void noteMotion(const Document& document) {
        const bool all = !(document.camera == seen_camera_) || !(document.view == seen_view_);
        seen_camera_ = document.camera;
        seen_view_ = document.view;
        for (const Lane& lane : document.lanes) {
            std::uint64_t& seen = seen_lods_[lane.id];
            if (all || seen != lane.status.lod_revision)
                rests_at_[lane.id] = Clock::now() + kRest;
            seen = lane.status.lod_revision;
        }
        const auto gone = [&](const auto& entry) { return !document.findLane(entry.first); };
        std::erase_if(seen_lods_, gone);
        std::erase_if(rests_at_, gone);
    }

    // The camera turned as it is, near enough that the part, or the whole scene if it is empty,
    // fills the views.
    CameraState framedCamera(const Document& document, const Bounds& part) {
        if (framed_scene_ != document.scene) {
            framed_scene_ = document.scene;
            frame_points_ = framePoints(*document.scene, document.bounds);
        }
        const double aspect = viewAspect();
        OrbitCamera camera = orbitCamera(document.camera, document.bounds, aspect);
        if (part.empty)
            frameCamera(camera, frame_points_, aspect);
        else
            frameSelection(camera, part, aspect);
        CameraState framed = document.camera;
        framed.target = camera.target;
        framed.distance = camera.distance;
        return framed;
    }

    bool takePictures(const std::vector<ViewSet::Picture>& drawn) {
        bool changed = drawn.size() != shown_.size();
        shown_.clear();
        stale_ = false;
        shows_draft_ = false;
        for (const ViewSet::Picture& picture : drawn) {
            changed = changed || picture.drew;
            stale_ = stale_ || picture.stale;
            shows_draft_ = shows_draft_ || picture.draft;
            if (const Lane* const lane = session_.document().findLane(picture.key);
                lane && picture.drew) {
                drafts_.setCosts(*lane, picture.cost_ms, picture.draft_cost_ms);
                if (picture.cost_ms > 0.0)
                    session_.setFrameTime(picture.key, picture.cost_ms);
            }
            shown_.push_back(
                {picture.key,
                 // NOLINTNEXTLINE(performance-no-int-to-ptr): what Dear ImGui calls a texture
                 reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture.texture)),
                 picture.stale || picture.draft});
        }
        drafts_.forgetOthers(session_.document());
        return changed;
    }

    GlContext& context_;
    Session& session_;
    ViewSet pictures_;
    Drafts drafts_;
    ui::Host host_;
    ui::Window window_;
    ui::WindowFacts facts_;
    CommandQueue commands_;
    std::vector<ui::LanePicture> shown_;
    FrameTimes frame_times_;
    ScenePtr framed_scene_;
    FramePoints frame_points_; // of framed_scene_
    CameraState seen_camera_;
    DisplayOptions seen_view_;
    std::map<LaneId, std::uint64_t> seen_lods_;    // lod_revision
    std::map<LaneId, Clock::time_point> rests_at_; // drafts until then
    Clock::time_point begun_ = Clock::now();       // this frame
    Clock::time_point wake_at_ = Clock::now();
    int settle_ = kSettlePasses;
    bool stale_ = false;
    bool shows_draft_ = false;
};

int openWindow(const WindowRequest& request, const CliEnvironment& environment) {
    const auto context = createWindowContext({});
    if (!context) {
        environment.err << "lodestone: " << context.error().message
                        << "; writing the comparison instead\n";
        return compareWithoutDisplay(request, environment);
    }
    const auto renderer = Renderer::create(**context);
    if (!renderer) {
        environment.err << "lodestone: " << renderer.error().message << '\n';
        return exitCode(renderer.error().kind);
    }
    Session::Options options;
    options.recent_file = defaultRecentFile();
    options.log_file = uiLogFileFromEnvironment();
    Session session(options);
    WindowLoop loop(**context, *renderer, session, request);
    loop.run(environment.stop);
    return 0;
}

#else

int openWindow(const WindowRequest& request, const CliEnvironment& environment) {
    environment.err << "lodestone: built without a window; writing the comparison instead\n";
    return compareWithoutDisplay(request, environment);
}

#endif

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
