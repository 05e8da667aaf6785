#pragma once
// Undo and redo as snapshots of everything the user edits: small values, no geometry.
#include "app/lane.h"

#include <deque>

namespace lodestone {

struct EditedLane {
    LaneId id = kNoLane;
    LaneSettings settings;

    friend bool operator==(const EditedLane&, const EditedLane&) = default;
};

// What undo brings back.
struct Edits {
    std::vector<EditedLane> lanes;
    Target master;
    std::optional<double> master_px;
    std::vector<double> importance;
    std::vector<bool> locked;
    ExportOptions export_options;
};

bool operator==(const Edits& a, const Edits& b);

// Names the widget and object a drag works on; equal, non-zero keys in a row are one undo step.
using DragKey = std::uint64_t;

class History {
public:
    // Records the state before an edit. The same non-zero key as the last time: nothing is added.
    void record(Edits before, std::string name, DragKey drag);

    // Ends a drag: the next edit is a step of its own.
    void endDrag() { drag_ = 0; }

    // Edits of one drag are still coming in.
    bool dragging() const { return drag_ != 0; }

    bool canUndo() const { return !undo_.empty(); }

    bool canRedo() const { return !redo_.empty(); }

    std::string_view undoName() const; // "Set ratio"; empty if there is nothing to undo
    std::string_view redoName() const;
    // now: the present state, kept for the other direction. Call only if canUndo() / canRedo().
    Edits undo(Edits now);
    Edits redo(Edits now);

private:
    struct Step {
        Edits edits;
        std::string name;
    };

    std::deque<Step> undo_; // oldest first, at most kMaximumSteps
    std::vector<Step> redo_;
    DragKey drag_ = 0;
};

} // namespace lodestone
