#pragma once
// One global order of all steps of all submeshes, and what every position of it looks like.
#include "simplify/collapse/removal.h"
#include "simplify/collapse/sequence.h"
#include "simplify/lod_source.h"

namespace lodestone {

// Everything slow about a lane, shared by its schedules.
struct SequenceSet {
    ScenePtr scene;
    std::vector<InstanceRange> ranges;       // [submeshes]
    std::vector<CollapseSequence> sequences; // [submeshes]
    std::vector<RemovalSequence> removals;   // [submeshes] empty costs: nothing to remove
    std::vector<double> max_stretch;         // [submeshes] of its instances
    double diagonal = 1.0;                   // robust, world
    std::vector<std::string> notes;          // for the user
};

// The state of one submesh at a position.
struct SubmeshState {
    std::uint32_t step = 0; // of its collapses
    std::uint32_t kept_instances = 0;

    bool operator==(const SubmeshState&) const = default;
};

class Schedule {
public:
    // Steps of a submesh: its collapses down to its floor, then its removals. Their order never
    // changes; how the submeshes interleave is the ordering's choice. O(steps log submeshes).
    // bytes: may be null unless the ordering is by byte.
    Schedule(const SequenceSet& set, const ScheduleOptions& options, const ByteModel* bytes);

    std::uint64_t positionCount() const { return triangles_.size(); }

    std::uint64_t trianglesAt(std::uint64_t position) const { return triangles_[position]; }

    double errorAt(std::uint64_t position) const { return error_[position]; } // % of the diagonal

    SubmeshState stateAt(std::size_t submesh, std::uint64_t position) const;

private:
    const SequenceSet* set_;                            // outlives the schedule
    std::vector<std::vector<std::uint32_t>> positions_; // [submeshes][its steps] where they come
    std::vector<std::uint64_t> triangles_;              // [positions]
    std::vector<float> error_;                          // [positions]
};

} // namespace lodestone
