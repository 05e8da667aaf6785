#pragma once
// Everything a user can do, as values. Panels, keys, tests and the command line send the same ones.
#include "app/document.h"

#include <utility>
#include <variant>

namespace lodestone {

// --- requests: carried out by Session, no effect on the document by applyCommand() ---
struct OpenScene {
    std::filesystem::path path;
};

struct OpenSample {
    std::string name; // of sampleNames()
    std::uint64_t seed = 1;
};

struct Export {
    LaneId lane = kNoLane;
    std::filesystem::path path; // .glb or .gltf
};

struct MeasureLane {
    LaneId lane = kNoLane; // kNoLane: every lane
};

struct MeasureRates {}; // every lane by the papers' protocol: the window draws them

struct CancelJob {
    JobId job = 0; // 0: every job
};

struct RetryLane { // after Failed or a cancelled build
    LaneId lane = kNoLane;
};

// --- edits: undoable. `drag`: non-zero and equal for all edits of one slider drag ---
struct AddLane {
    std::string algorithm; // id; empty: Original
};

struct DuplicateLane {
    LaneId lane = kNoLane;
};

struct RemoveLane {
    LaneId lane = kNoLane;
};

struct SetLanes { // exactly these, in this order; lanes that are there already stay as they are
    std::vector<std::string> algorithms; // ids; empty text: Original
};

struct MoveLane {
    LaneId lane = kNoLane;
    std::uint32_t index = 0; // its place afterwards
};

struct SetLaneAlgorithm {
    LaneId lane = kNoLane;
    std::string algorithm; // id; empty: Original
};

struct SetLaneParameter {
    LaneId lane = kNoLane;
    std::string parameter;
    double value = 0.0; // clamped to the parameter's range
    DragKey drag = 0;
};

struct SetLaneTarget { // the lane stops following the master
    LaneId lane = kNoLane;
    Target target;
    DragKey drag = 0;
};

struct SlideLane { // as SetLaneTarget; until EndDrag the vertices slide as the ratio moves
    LaneId lane = kNoLane;
    double ratio = 1.0; // 0..1
    DragKey drag = 0;
};

struct SetMasterTarget { // every following lane gets it
    Target target;       // Ratio, Triangles or Bytes
    DragKey drag = 0;
};

struct SetLanePixels { // an error that follows the camera; the lane stops following the master
    LaneId lane = kNoLane;
    double pixels = 1.0; // > 0
    DragKey drag = 0;
};

struct SetMasterPixels {
    double pixels = 1.0; // > 0
    DragKey drag = 0;
};

struct FollowMaster {
    LaneId lane = kNoLane;
    bool follows = true;
};

struct SetOrdering {
    LaneId lane = kNoLane;
    Ordering ordering = Ordering::Triangle;
};

struct SetImportance {
    std::vector<std::uint32_t> submeshes;
    double importance = 1.0; // clamped to 0.1..10
    DragKey drag = 0;
};

struct SetLocked {
    std::vector<std::uint32_t> submeshes;
    bool locked = true;
};

struct SetExportOptions {
    ExportOptions options;
};

struct StepCollapses { // > 0: that many steps coarser, < 0: split back
    LaneId lane = kNoLane;
    std::int64_t steps = 1;
    DragKey drag = 0;
};

struct Undo {};

struct Redo {};

struct EndDrag {}; // the mouse was released: the next edit is a new undo step

// --- view: not undoable ---
struct SetActiveLane {
    LaneId lane = kNoLane;
};

struct Select {
    enum class Mode : std::uint8_t { Replace, Add, Toggle };
    std::vector<SelectedItem> items;
    Mode mode = Mode::Replace;
};

struct SetCamera {
    CameraState camera;
};

struct FrameScene {}; // the camera that shows everything

struct FrameSelection {}; // as FrameScene if nothing is selected

struct SetView {
    DisplayOptions view;
};

struct ClearMessages {};

using Command = std::variant<OpenScene,
                             OpenSample,
                             Export,
                             MeasureLane,
                             MeasureRates,
                             CancelJob,
                             RetryLane,
                             AddLane,
                             DuplicateLane,
                             RemoveLane,
                             SetLanes,
                             MoveLane,
                             SetLaneAlgorithm,
                             SetLaneParameter,
                             SetLaneTarget,
                             SlideLane,
                             SetMasterTarget,
                             SetLanePixels,
                             SetMasterPixels,
                             FollowMaster,
                             SetOrdering,
                             SetImportance,
                             SetLocked,
                             SetExportOptions,
                             StepCollapses,
                             Undo,
                             Redo,
                             EndDrag,
                             SetActiveLane,
                             Select,
                             SetCamera,
                             FrameScene,
                             FrameSelection,
                             SetView,
                             ClearMessages>;

// Filled by panels while a frame is drawn, emptied by Session::update. Main thread only.
class CommandQueue {
public:
    void push(Command command) { commands_.push_back(std::move(command)); }

    std::vector<Command> take() { return std::exchange(commands_, {}); }

    bool empty() const { return commands_.empty(); }

private:
    std::vector<Command> commands_;
};

// Changes the document. An edit that names a missing lane, parameter or submesh, or brings a
// non-finite number, changes nothing and reports a warning. applyCommand + Undo restores every
// edited value. An edit that changes nothing leaves no undo step. Main thread.
void applyCommand(Document& document, const Command& command);

} // namespace lodestone
