#pragma once
// A lane: algorithm + parameters + target, and what has become of it.
#include "app/error_map.h"
#include "app/lane_textures.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"

#include <optional>
#include <span>

namespace lodestone {

using LaneId = std::uint32_t; // never reused within a session; 0: none
constexpr LaneId kNoLane = 0;

struct Rgb {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;

    friend bool operator==(const Rgb&, const Rgb&) = default;
};

// What the user edits; undo restores exactly this.
struct LaneSettings {
    const Algorithm* algorithm = nullptr; // a row of algorithms(); nullptr: Original
    ParameterValues parameters;           // missing: default
    Ordering ordering = Ordering::Triangle;
    Target target{Target::Kind::Ratio, 0.2};
    // Stepping edge by edge leaves the target and holds a position until the next target.
    std::optional<std::uint64_t> position;
    // Set: the target is an error and follows the camera, so that it is this many pixels in view.
    std::optional<double> error_px;
    bool follows_master = true;
    Rgb colour;
};

bool operator==(const LaneSettings& a, const LaneSettings& b);

enum class LaneState : std::uint8_t { Idle, Queued, Building, Ready, Failed };

std::string_view laneStateName(LaneState state); // "idle", "queued", ...

// What a lane shows. Kept while a newer build runs, so the last good picture stays on screen.
struct LaneNumbers {
    std::uint64_t triangles = 0; // kept instances counted
    std::uint64_t unique_triangles = 0;
    std::uint64_t instances = 0;
    double ratio = 1.0; // of the original's instanced triangles
    // With the document's export options: exact, but for what isEstimated() names and for textures
    // that are still to be transferred.
    std::uint64_t predicted_bytes = 0;
    bool bytes_estimated = false; // such textures count in predicted_bytes
    // predicted_bytes with the textures that the scene has: what targets and charts go by.
    std::uint64_t kept_bytes = 0;
    double error_estimate = 0.0; // % of the diagonal
    std::string note;            // why the target was missed; empty if met
};

// By the papers' protocol: drawn off screen again and again.
struct MeasuredRate {
    double mean_ms = 0.0; // of a frame
    std::uint64_t frames = 0;
};

struct LaneStatus {
    LaneState state = LaneState::Idle;
    std::string failure;            // LaneState::Failed: one line
    double progress = 0.0;          // LaneState::Building: 0..1
    LodSourcePtr source;            // null: Original, or not built yet
    ScenePtr scene;                 // whose submeshes `lod` replaces; null: nothing to draw yet
    std::shared_ptr<const Lod> lod; // shown; null: nothing to draw yet
    std::uint64_t lod_revision = 0; // rises whenever `lod` is another
    LaneNumbers numbers;            // of `lod`
    double build_seconds = 0.0;     // sequence + schedule
    double readout_ms = 0.0;
    std::optional<Distance> distance; // measured, of the `lod` shown
    bool measuring = false;
    std::optional<MeasuredRate> rate; // measured, of the `lod` shown
    bool rate_wanted = false;         // to be measured by the window
    ErrorMap error_map;               // of an earlier `lod` while a newer one is made
    std::optional<double> flip; // image difference in the present view; filled in by the window
    double frame_ms = 0.0;      // this lane's own draw; filled in by the window, 0: unknown
    LaneTexturesPtr textures;   // transferred; of an earlier `lod` or options while newer are made
    std::optional<double> texture_progress; // 0..1 while textures are transferred
    std::string texture_failure;            // why there are none; one line, empty: nothing wrong
};

// What a view draws of a lane.
struct DrawnLod {
    ScenePtr scene;
    std::shared_ptr<const Lod> lod;
};

// The LOD with its transferred textures; those it has kept while there are none of this LOD.
DrawnLod drawnLod(const LaneStatus& status);

struct Lane {
    LaneId id = kNoLane;
    LaneSettings settings;
    std::uint64_t revision = 1; // rises when a build would come out differently
    bool slides = false;        // to its target, a ratio: its picture is a geomorph
    LaneStatus status;
};

// "Original", "IAS", ...
std::string_view laneName(const LaneSettings& settings);
// The colour of an algorithm's lanes; further lanes of the same algorithm are lighter.
Rgb laneColour(const Algorithm* algorithm, std::uint32_t earlier_lanes_of_it);

// The first of those that no lane of that algorithm has, `except` left aside.
Rgb freeLaneColour(std::span<const Lane> lanes, const Algorithm* algorithm, LaneId except);

} // namespace lodestone
