#pragma once
// What the window remembers besides the document: open dialogs, layout, what the mouse drags.
#include "app/session.h"
#include "ui/file_browser.h"
#include "ui/size_curves.h"
#include "ui/ui.h"

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

namespace lodestone::ui {

// A lane's picture, drawn by someone else. texture: 0 for none; row 0 at the bottom.
struct LanePicture {
    LaneId lane = kNoLane;
    ImTextureID texture = nullptr;
    bool draft = false;        // not yet the LOD and camera that the lane stands at
    std::uint64_t version = 0; // another for every picture drawn
};

// What the grid needs pictures of, in framebuffer pixels.
struct ViewRequest {
    LaneId lane = kNoLane;
    int width_px = 0;
    int height_px = 0;
};

// Facts of the window that no document knows.
struct WindowFacts {
    std::string renderer; // GL_RENDERER
    int width_px = 0;     // framebuffer
    int height_px = 0;
    float density = 1.0f;    // framebuffer pixels per window unit
    std::uint64_t frame = 0; // drawn so far
    // What is seen at a point of a lane's view: 0..1 from the left and from the top.
    std::function<std::optional<SelectedItem>(LaneId, const glm::dvec2&)> pick;
    // A texture of a lane's as a picture, row 0 at the bottom; nullptr: it cannot be shown.
    std::function<ImTextureID(const LaneTexturesPtr&, const ImagePreview&)> preview;
    // All that is between two corners, the upper left one first.
    std::function<std::vector<SelectedItem>(LaneId, const glm::dvec2&, const glm::dvec2&)> pickBox;
};

struct PanelInput {
    Session& session;
    const Document& document;
    std::span<const LanePicture> pictures;
    const WindowFacts& facts;

    const LanePicture* pictureOf(LaneId lane) const {
        for (const LanePicture& picture : pictures)
            if (picture.lane == lane)
                return &picture;
        return nullptr;
    }
};

enum class Dialog : std::uint8_t { None, Open, Export, Shortcuts, About, Quit, Textures };

struct ExportForm {
    std::string path;
    bool overwrite_asked = false;
    bool focus_path = false;
    std::string problem; // one line; empty: none
};

// A lane that is walked down and up its schedule.
struct Animation {
    LaneId lane = kNoLane; // kNoLane: off
    double begin_s = 0.0;
};

// The animations of the scene, and whether time passes.
struct Playback {
    ScenePtr scene;
    RigPtr rig; // of the scene; null without one
    bool playing = false;
};

// The scene panel's list: heaviest submeshes first. Made once a scene, for frames do nothing that
// takes the longer the more instances there are.
struct SubmeshOrder {
    ScenePtr scene;
    std::vector<std::uint32_t> submeshes;
    std::vector<InstanceRange> ranges;   // [scene.submeshes]
    SelectedItem revealed{kNone, kNone}; // the list was scrolled to it
};

// What a chart shows over the triangles.
enum class ChartKind : std::uint8_t { Size, Error };

struct WindowState {
    Dialog dialog = Dialog::None;
    bool dialog_opens = false; // in the next frame
    bool panels_hidden = false;
    bool welcome = false;
    bool quit = false;             // answered: really
    bool drag_moves_light = false; // a left drag in a view
    LaneId box_lane = kNoLane;     // in whose view a box is being dragged
    LaneId moved_lane = kNoLane;   // whose header is being dragged
    Animation animation;
    Playback playback;
    ChartKind chart = ChartKind::Size;
    std::string sheet_filter; // of the list of keys
    SubmeshOrder submesh_order;
    bool full_screen_toggled = false; // wanted; whoever owns the window clears it
    int cell_count = 0;               // views in the grid; 0: one for each lane
    FileBrowser browser;
    ExportForm export_form;
    int shown_atlas = 0; // of the active lane, beside what it was made from
    SizeCurves curves;
    std::vector<ViewRequest> views; // of this frame
    std::uint64_t seen_message = 0; // sequence of the newest message when its toast was closed
    double toast_begin_s = 0.0;
    std::uint64_t toast_message = 0; // sequence shown as a toast
    double wake_in_s = kNever;       // something will look different without any input by then

    static constexpr double kNever = 1e9;

    void open(Dialog which) {
        dialog = which;
        dialog_opens = true;
    }

    void wakeIn(double delay_s) { wake_in_s = delay_s < wake_in_s ? delay_s : wake_in_s; }

    void animate() { wakeIn(1.0 / 30.0); }
};

} // namespace lodestone::ui
