#include "app/main/window_loop.h"

#include "app/frame_times.h"
#include "app/main/lane_pictures.h"
#include "app/main/preview_textures.h"
#include "app/main/texture_id.h"
#include "ui/host.h"
#include "ui/window.h"

#include <algorithm>
#include <ostream>

namespace lodestone {

namespace {

// The window's loop: events, commands, session, pictures, interface. Sleeps while nothing changes.
class WindowLoop {
public:
    WindowLoop(GlContext& context,
               const Renderer& renderer,
               Session& session,
               const WindowRequest& request)
        : context_(context), session_(session), pictures_(context, renderer),
          host_(context.nativeWindow()),
          window_(session, host_.theme(), {.welcome = !request.file}) {
        session_.setFraming([this](const Document& document, const Bounds& part) {
            return pictures_.framedCamera(document, part);
        });
        facts_.pick = [this](LaneId lane, const glm::dvec2& point) {
            return pictures_.pick(session_.document(), lane, point);
        };
        facts_.pickBox = [this](LaneId lane, const glm::dvec2& min, const glm::dvec2& max) {
            return pictures_.pickBox(session_.document(), lane, {min, max});
        };
        facts_.preview = [this](const LaneTexturesPtr& textures, const ImagePreview& preview) {
            return textureId(previews_.of(textures, preview));
        };
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
            frame_times_.begin();
            window_.drop(host_.takeDroppedFiles(), commands_);
            if (host_.takeCloseRequest())
                window_.askToQuit();
            if (session_.update(commands_))
                settle_ = std::max(settle_, 1);
            frame_times_.ended(FramePart::Session);
            const bool due = std::chrono::steady_clock::now() >= wake_at_;
            if (!host_.minimised() && (settle_ > 0 || pictures_.stale() || due))
                drawFrame();
        }
    }

private:
    using Clock = std::chrono::steady_clock;

    static constexpr int kSettlePasses = 3; // frames until hovering and layout have settled
    static constexpr std::chrono::milliseconds kDeliveryPoll{10};
    static constexpr double kLongestWaitSeconds = 0.5; // finished jobs are noticed within it

    // "llvmpipe" of "llvmpipe (LLVM 15.0.6, 256 bits)".
    static std::string shortRendererName(const std::string& renderer) {
        return renderer.substr(0, renderer.find(" ("));
    }

    double waitTime() const {
        if (settle_ > 0 || pictures_.stale())
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
        window_.draw(facts_, pictures_.shown(), commands_);
        frame_times_.ended(FramePart::Interface);
        bool again = session_.update(commands_);
        const Document& document = session_.document();
        const bool other_shape = pictures_.noteShape(document, window_.views());
        if (document.scene && (document.camera.distance <= 0.0 || other_shape)) {
            commands_.push(FrameScene{});
            again = session_.update(commands_) || again;
        }
        frame_times_.ended(FramePart::Session);
        again = pictures_.draw(session_, window_.views(), begun_) || again;
        frame_times_.ended(FramePart::Pictures);
        if (again) { // numbers and pictures of this frame, not of the last one
            host_.discardPass();
            host_.beginPass();
            window_.draw(facts_, pictures_.shown(), commands_);
            frame_times_.ended(FramePart::Interface);
        }
        clearWindow(
            {facts_.width_px, facts_.height_px, 0x14 / 255.0f, 0x17 / 255.0f, 0x1b / 255.0f});
        host_.endFrame();
        previews_.endFrame();
        context_.swapBuffers();
        finishFrame();
    }

    void finishFrame() {
        logPictures();
        session_.uiLog().frame(++facts_.frame);
        frame_times_.ended(FramePart::Output);
        if (const auto told = frame_times_.finish())
            session_.uiLog().object("frames", "frames", *told);
        if (!commands_.empty())
            settle_ = std::max(settle_, 2);
        const double wake_s = std::min(window_.wakeIn(), 3600.0);
        wake_at_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                      std::chrono::duration<double>(wake_s));
        wake_at_ = pictures_.nextRefinement(begun_, wake_at_);
        if (pictures_.waiting())
            wake_at_ = std::min(wake_at_, Clock::now() + kDeliveryPoll);
        if (window_.takeFullScreenToggle())
            host_.toggleFullScreen();
        const Document& document = session_.document();
        host_.setTitle(document.scene ? document.scene->name + " \u2013 Lodestone" : "Lodestone");
    }

    // For tests: which picture each view shows, how many do, and whether all show what they should.
    void logPictures() {
        if (!session_.uiLog().enabled())
            return;
        for (const ui::LanePicture& picture : pictures_.shown())
            session_.uiLog().object("picture",
                                    std::to_string(picture.lane),
                                    "\"version\":" + std::to_string(picture.version));
        const bool final = pictures_.final() && session_.document().jobs.empty();
        const auto shown =
            std::ranges::count_if(pictures_.shown(), [](const ui::LanePicture& picture) {
                return picture.texture != nullptr;
            });
        session_.uiLog().object("pictures",
                                "pictures",
                                "\"shown\":" + std::to_string(shown) +
                                    (final ? ",\"final\":true" : ",\"final\":false"));
    }

    GlContext& context_;
    Session& session_;
    LanePictures pictures_;
    PreviewTextures previews_;
    ui::Host host_;
    ui::Window window_;
    ui::WindowFacts facts_;
    CommandQueue commands_;
    FrameTimes frame_times_;
    Clock::time_point begun_ = Clock::now(); // this frame
    Clock::time_point wake_at_ = Clock::now();
    int settle_ = kSettlePasses;
};

} // namespace

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

} // namespace lodestone
