#include "app/history.h"

#include <cassert>

namespace lodestone {

namespace {

constexpr std::size_t kMaximumSteps = 200;

} // namespace

bool operator==(const Edits& a, const Edits& b) {
    return a.lanes == b.lanes && a.master.kind == b.master.kind &&
           a.master.value == b.master.value && a.master_px == b.master_px &&
           a.importance == b.importance && a.locked == b.locked &&
           a.export_options == b.export_options;
}

void History::record(Edits before, std::string name, DragKey drag) {
    redo_.clear();
    const bool same_drag = drag != 0 && drag == drag_ && !undo_.empty();
    drag_ = drag;
    if (same_drag)
        return;
    undo_.push_back({std::move(before), std::move(name)});
    if (undo_.size() > kMaximumSteps)
        undo_.pop_front();
}

std::string_view History::undoName() const {
    return undo_.empty() ? std::string_view() : undo_.back().name;
}

std::string_view History::redoName() const {
    return redo_.empty() ? std::string_view() : redo_.back().name;
}

Edits History::undo(Edits now) {
    assert(canUndo());
    drag_ = 0;
    Step step = std::move(undo_.back());
    undo_.pop_back();
    redo_.push_back({std::move(now), std::move(step.name)});
    return std::move(step.edits);
}

Edits History::redo(Edits now) {
    assert(canRedo());
    drag_ = 0;
    Step step = std::move(redo_.back());
    redo_.pop_back();
    undo_.push_back({std::move(now), std::move(step.name)});
    return std::move(step.edits);
}

} // namespace lodestone
