#pragma once
// The state of the window: scene, lanes, edits. Main thread only. Changed by
// applyCommand(Document&, Command) and by Session; panels read it.
#include "app/history.h"
#include "app/lane.h"
#include "app/view_state.h"

#include <filesystem>

namespace lodestone {

enum class Severity : std::uint8_t { Info, Warning, Error };

struct Message {
    Severity severity = Severity::Info;
    std::string text;
    std::uint32_t count = 1;    // repeats are counted, not listed again
    std::uint64_t sequence = 0; // rises with every report; the newest is the highest
};

enum class LoadState : std::uint8_t { Empty, Loading, Loaded };

using JobId = std::uint64_t;

enum class JobKind : std::uint8_t { Load, Prepare, Export, Measure, Predict, ErrorMap, Texture };

std::string_view jobKindName(JobKind kind);

// A running or waiting job as the status bar shows it.
struct JobStatus {
    JobId id = 0;
    JobKind kind = JobKind::Load;
    LaneId lane = kNoLane;
    std::string label; // "Building IAS"
    bool running = false;
    double progress = 0.0; // 0..1
    double elapsed_s = 0.0;
    std::optional<double> remaining_s; // unknown at first
};

struct Document {
    ScenePtr scene;             // the original; null: nothing open
    std::filesystem::path path; // empty for a sample
    LoadState load_state = LoadState::Empty;
    SceneCounts counts;           // of `scene`
    Bounds bounds;                // robust world bounds of `scene`
    double texels_per_unit = 0.0; // mean over the surface of `scene`; 0: it has no textures

    std::vector<Lane> lanes; // in display order
    LaneId active_lane = kNoLane;
    LaneId next_lane_id = 1;
    // Ratio or Triangles: equal triangles; Bytes: equal bytes; Error: only with master_px.
    Target master{Target::Kind::Ratio, 0.2};
    std::optional<double> master_px; // as LaneSettings::error_px
    std::vector<double> importance;  // [submeshes] 0.1..10; empty: all 1
    std::vector<bool> locked;        // [submeshes]; empty: none
    ExportOptions export_options;

    CameraState camera;
    DisplayOptions view;
    std::vector<SelectedItem> selection; // sorted, unique
    double view_side_px = 512.0;         // shorter side of a view; filled in by the window

    std::vector<JobStatus> jobs;               // refreshed every frame
    std::vector<Message> messages;             // the newest last
    std::vector<std::filesystem::path> recent; // newest first
    std::optional<std::filesystem::path> last_export;

    History history;
    std::uint64_t revision = 0;       // rises with every edit, undo and redo
    std::uint64_t saved_revision = 0; // of the last export or load: dirty() compares
    std::uint64_t scene_revision = 0; // rises when `scene` is another

    bool dirty() const { return revision != saved_revision; }

    Lane* findLane(LaneId id);             // nullptr if gone
    const Lane* findLane(LaneId id) const; // nullptr if gone
};

// Adds a message, or counts it up where the same text and severity stand already.
void report(Document& document, Severity severity, std::string text);
// The worst and then newest message, or nullptr.
const Message* topMessage(const Document& document);

// What the algorithm's schedule gets for a lane: the lane's ordering, the document's importance and
// locks. Those speak of submeshes, which an expanding algorithm dissolves: left out for it.
ScheduleOptions scheduleOptions(const Document& document, const LaneSettings& settings);

// A scene with what the document needs to know of it, computed off the main thread.
struct LoadedScene {
    ScenePtr scene;
    std::filesystem::path path; // empty for a sample
    SceneCounts counts;
    Bounds bounds;
    double texels_per_unit = 0.0; // see Document
};

// Counts, bounds and texels of a scene. Any thread; O(instanced vertices).
LoadedScene describeScene(ScenePtr scene, std::filesystem::path path);

// Makes `loaded` the open document: lanes Original, IAS and Quadric (those that exist) at 20 %,
// camera framed, history empty. Messages, recent files, shading and export options stay.
void resetDocument(Document& document, LoadedScene loaded);

// A lane that is in no list yet: its own id, the master's target, a colour no other lane of the
// algorithm has. algorithm: nullptr for Original.
Lane makeLane(Document& document, const Algorithm* algorithm);

// The lane to begin with: IAS, else the first that simplifies, else the first; kNoLane: no lane.
LaneId startingLane(const Document& document);

// World bounds of what is selected (corner boxes of its instances); empty if nothing is.
Bounds selectionBounds(const Document& document);

// The error, in % of the diagonal, that is this many pixels large at the camera's target.
double errorOfPixels(const Document& document, double pixels);
// Moves the targets that are given in pixels after the camera.
void followView(Document& document);

// What undo brings back, and bringing it back: a lane that existed before and after keeps its
// status.
Edits editsOf(const Document& document);
void restoreEdits(Document& document, const Edits& edits);

} // namespace lodestone
