#pragma once
// Glue between document, jobs and algorithms: what happens once a frame. Main thread; no GL.
#include "app/commands.h"
#include "app/ui_log.h"

#include <functional>
#include <memory>

namespace lodestone {

class Session {
public:
    struct Options {
        std::uint32_t worker_threads = 2;  // concurrent jobs; each runs its loops on oneTBB
        std::filesystem::path recent_file; // list of recent files; empty: not kept
        std::filesystem::path log_file;    // JSON lines of lanes, jobs, messages; empty: none
        std::function<void()> wake; // a job has finished; called from its thread; may be empty
    };

    explicit Session(Options options);
    ~Session(); // cancels and joins every job

    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const Document& document() const;
    // Once a frame: carries out the commands, commits finished jobs, starts needed ones, and reads
    // out the LOD of every ready lane whose target moved (in this call: edge-collapse lanes follow
    // a slider in the same frame). Returns true if something on screen changed.
    bool update(CommandQueue& commands);
    // Until no job is left, for tests and the command line; stops early after timeout_s.
    // Returns whether it got there.
    bool updateUntilIdle(double timeout_s);

    // Size of a lane's LOD written with other options, for the export dialog. Cached per scene and
    // options. 0 if the lane shows nothing, and while a job works it out.
    struct PredictedSize {
        std::uint64_t bytes = 0;
        bool estimated = false; // else exact
    };

    PredictedSize predictedSize(LaneId lane, const ExportOptions& options);
    // What the window finds out: what drawing a lane cost, what measuring its rate gave, how much
    // its picture differs from the original's (nullopt: not known any more), and how large views
    // are.
    void setFrameTime(LaneId lane, double frame_ms);
    void setRate(LaneId lane, const std::optional<MeasuredRate>& rate);
    void setFlip(LaneId lane, std::optional<double> flip);
    void setViewSide(double shorter_side_px);
    // What FrameScene, FrameSelection and opening a scene do to the camera where a view's shape is
    // known; part: empty for everything. Without it bounding spheres are framed.
    using Framing = std::function<CameraState(const Document&, const Bounds& part)>;
    void setFraming(Framing framing);
    // Something outside the session went wrong: one line for the user. Repeats are counted.
    void reportError(std::string message);
    // Shared with the panels, which add widget rectangles.
    UiLog& uiLog();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// $XDG_CONFIG_HOME/lodestone/recent or ~/.config/lodestone/recent; empty if there is no home.
std::filesystem::path defaultRecentFile();
// $LODESTONE_UI_LOG, or empty.
std::filesystem::path uiLogFileFromEnvironment();

} // namespace lodestone
