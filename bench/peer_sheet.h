#pragma once
// What peers and we make of one scene.
#include "bench/peers/files.h"
#include "bench/timing.h"
#include "scene/scene.h"

namespace lodestone::bench {

constexpr double kPeerRatio = 0.2; // of every mesh's triangles

enum class PeerKind : std::uint8_t {
    Call,    // timed around the call alone, against our call
    Program, // timed as a process from file to file, against our process
    Ours,    // another way of ours
};

// A level of detail and what it is worth.
struct Worth {
    std::uint64_t triangles = 0; // instances counted
    std::uint64_t instances = 0;
    std::uint64_t bytes = 0;           // of its file
    std::uint64_t predicted_bytes = 0; // before it was written; 0: not ours
    double maximum = 0.0;              // distance, % of the diagonal
    double mean = 0.0;
    double flip = 0.0; // image difference, 0..1; not finite: no pictures
};

struct PeerRow {
    std::string name;
    PeerKind kind = PeerKind::Call;
    Spread seconds;
    double time_ratio = 0.0; // over ours
    Worth theirs;
    Worth ours;          // at as many triangles, or as near below as we get
    std::string failure; // why there are no figures; empty: there are
};

struct PeerSheet {
    std::string input;
    std::uint64_t triangles = 0; // of the scene, instances counted
    std::uint64_t unique_triangles = 0;
    std::uint64_t instances = 0;
    std::string ours_name;
    Spread our_seconds;         // of the call
    Spread our_program_seconds; // of the process; median 0: not run
    Worth ours;                 // at the ratio
    int files_of_ours = 0;
    int files_as_predicted = 0; // of those, where the predicted size is the written one
    std::vector<PeerRow> rows;
    std::string picture_failure; // why there are no pictures; empty: there are
};

// How the sheets are made, the same for all scenes.
struct PeerBench {
    std::vector<MeshPeer> meshes;
    std::vector<FilePeer> files;
    std::string lodestone; // our program; empty: processes are not timed against it
    int rounds = 5;
    std::uint64_t samples = 300'000; // of the distance, a side
    std::uint32_t picture_px = 256;  // width and height of each of 12 pictures
};

// Errors: those of our own algorithm, export and measures. A peer's go into its row.
Result<PeerSheet>
measurePeers(const PeerBench& bench, const std::string& input, const ScenePtr& scene);

} // namespace lodestone::bench
