#include "app/commands.h"

#include "scene/finite.h"

#include <algorithm>
#include <cmath>
#include <fmt/core.h>

namespace lodestone {

namespace {

constexpr std::size_t kMaximumLanes = 9; // the largest grid of views
constexpr double kMinimumImportance = 0.1;
constexpr double kMaximumImportance = 10.0;

void warn(Document& document, std::string text) {
    report(document, Severity::Warning, std::move(text));
}

// Runs an edit and records the state before it, unless nothing came out differently.
template <class Change>
void edit(Document& document, std::string name, DragKey drag, const Change& change) {
    Edits before = editsOf(document);
    change();
    if (before == editsOf(document))
        return;
    document.history.record(std::move(before), std::move(name), drag);
    ++document.revision;
}

Lane* laneOrWarn(Document& document, LaneId id) {
    Lane* lane = document.findLane(id);
    if (!lane)
        warn(document, fmt::format("lane {} is gone; nothing changed", id));
    return lane;
}

// nullopt for an unknown id, with a warning; nullptr for Original.
std::optional<const Algorithm*> algorithmOrWarn(Document& document, std::string_view id) {
    if (id.empty())
        return nullptr;
    const Algorithm* algorithm = findAlgorithm(id);
    if (algorithm)
        return algorithm;
    warn(document, fmt::format("there is no algorithm '{}'; nothing changed", id));
    return std::nullopt;
}

std::optional<Target> cleanTarget(Document& document, const Target& target) {
    if (!std::isfinite(target.value)) {
        warn(document, "a target must be a finite number; nothing changed");
        return std::nullopt;
    }
    Target clean = target;
    clean.value = std::max(clean.value, 0.0);
    if (clean.kind == Target::Kind::Ratio)
        clean.value = std::min(clean.value, 1.0);
    if (clean.kind == Target::Kind::Triangles || clean.kind == Target::Kind::Bytes)
        clean.value = std::floor(clean.value);
    return clean;
}

bool roomForLane(Document& document) {
    if (document.lanes.size() < kMaximumLanes)
        return true;
    warn(document, fmt::format("at most {} lanes; remove one first", kMaximumLanes));
    return false;
}

bool submeshesExist(Document& document, const std::vector<std::uint32_t>& submeshes) {
    const std::size_t count = document.scene ? document.scene->submeshes.size() : 0;
    const bool all = !submeshes.empty() &&
                     std::ranges::all_of(submeshes, [&](std::uint32_t s) { return s < count; });
    if (!all)
        warn(document, "no such submesh; nothing changed");
    return all;
}

// --- edits ---

void run(Document& document, const AddLane& command) {
    const auto algorithm = algorithmOrWarn(document, command.algorithm);
    if (!algorithm || !roomForLane(document))
        return;
    edit(document, "Add lane", 0, [&] {
        Lane lane = makeLane(document, *algorithm);
        document.active_lane = lane.id;
        document.lanes.push_back(std::move(lane));
    });
}

void run(Document& document, const DuplicateLane& command) {
    const Lane* original = laneOrWarn(document, command.lane);
    if (!original || !roomForLane(document))
        return;
    edit(document, "Duplicate lane", 0, [&] {
        Lane lane = makeLane(document, original->settings.algorithm);
        const Rgb colour = lane.settings.colour;
        lane.settings = original->settings;
        lane.settings.colour = colour;
        document.active_lane = lane.id;
        const auto place = document.lanes.begin() + (original - document.lanes.data()) + 1;
        document.lanes.insert(place, std::move(lane));
    });
}

void run(Document& document, const RemoveLane& command) {
    const Lane* lane = laneOrWarn(document, command.lane);
    if (!lane)
        return;
    edit(document, "Remove lane", 0, [&] {
        const std::ptrdiff_t index = lane - document.lanes.data();
        document.lanes.erase(document.lanes.begin() + index);
        if (document.active_lane != command.lane)
            return;
        const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(document.lanes.size()) - 1;
        document.active_lane =
            last < 0 ? kNoLane : document.lanes[static_cast<std::size_t>(std::min(index, last))].id;
    });
}

void run(Document& document, const SetLanes& command) {
    std::vector<const Algorithm*> wanted;
    for (const std::string& id : command.algorithms) {
        const auto algorithm = algorithmOrWarn(document, id);
        if (!algorithm)
            return;
        wanted.push_back(*algorithm);
    }
    if (wanted.empty() || wanted.size() > kMaximumLanes)
        return;
    edit(document, "Choose lanes", 0, [&] {
        std::vector<Lane> before = std::exchange(document.lanes, {});
        for (const Algorithm* const algorithm : wanted) {
            const auto same = std::ranges::find_if(before, [&](const Lane& lane) {
                return lane.id != kNoLane && lane.settings.algorithm == algorithm;
            });
            if (same != before.end()) {
                document.lanes.push_back(std::move(*same));
                same->id = kNoLane;
                continue;
            }
            document.lanes.push_back(makeLane(document, algorithm));
        }
        if (!document.findLane(document.active_lane))
            document.active_lane = startingLane(document);
    });
}

void run(Document& document, const MoveLane& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    if (!lane)
        return;
    edit(document, "Move lane", 0, [&] {
        Lane moved = std::move(*lane);
        document.lanes.erase(document.lanes.begin() + (lane - document.lanes.data()));
        const auto index = std::min<std::size_t>(command.index, document.lanes.size());
        document.lanes.insert(document.lanes.begin() + static_cast<std::ptrdiff_t>(index),
                              std::move(moved));
    });
}

void run(Document& document, const SetLaneAlgorithm& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    const auto algorithm = algorithmOrWarn(document, command.algorithm);
    if (!lane || !algorithm || lane->settings.algorithm == *algorithm)
        return;
    edit(document, "Set algorithm", 0, [&] {
        lane->settings.algorithm = *algorithm;
        lane->settings.parameters.clear();
        lane->settings.position.reset();
        lane->settings.colour = freeLaneColour(document.lanes, *algorithm, lane->id);
        ++lane->revision;
    });
}

void run(Document& document, const SetLaneParameter& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    if (!lane)
        return;
    const Algorithm* algorithm = lane->settings.algorithm;
    const ParameterInfo* info = nullptr;
    if (algorithm) {
        const auto found =
            std::ranges::find(algorithm->parameters, command.parameter, &ParameterInfo::id);
        info = found == algorithm->parameters.end() ? nullptr : &*found;
    }
    if (!info || !std::isfinite(command.value)) {
        warn(document,
             fmt::format("{} has no parameter '{}' of that value; nothing changed",
                         laneName(lane->settings),
                         command.parameter));
        return;
    }
    double value = std::clamp(command.value, info->minimum, info->maximum);
    if (info->kind != ParameterInfo::Kind::Number)
        value = std::round(value);
    edit(document, fmt::format("Set {}", info->label), command.drag, [&] {
        double& stored =
            lane->settings.parameters.try_emplace(command.parameter, info->fallback).first->second;
        if (stored == value)
            return;
        stored = value;
        if (info->of_textures)
            return; // of the same LOD
        lane->settings.position.reset();
        ++lane->revision;
    });
}

void run(Document& document, const SetLaneTarget& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    const auto target = cleanTarget(document, command.target);
    if (!lane || !target)
        return;
    edit(document, "Set target", command.drag, [&] {
        lane->settings.target = *target;
        lane->settings.error_px.reset();
        lane->settings.position.reset();
        lane->settings.follows_master = false;
    });
}

void run(Document& document, const SlideLane& command) {
    run(document, SetLaneTarget{command.lane, {Target::Kind::Ratio, command.ratio}, command.drag});
    if (Lane* lane = document.findLane(command.lane))
        lane->slides = std::isfinite(command.ratio);
}

void endSlides(Document& document) {
    for (Lane& lane : document.lanes)
        lane.slides = false;
}

void follow(Document& document, Lane& lane) {
    lane.settings.target = document.master;
    lane.settings.error_px = document.master_px;
    lane.settings.position.reset();
    lane.settings.follows_master = true;
}

void run(Document& document, const SetMasterTarget& command) {
    const auto target = cleanTarget(document, command.target);
    if (!target)
        return;
    if (target->kind == Target::Kind::Error) {
        warn(document, "the master sets triangles or bytes, not an error; nothing changed");
        return;
    }
    edit(document, "Set all targets", command.drag, [&] {
        document.master = *target;
        document.master_px.reset();
        for (Lane& lane : document.lanes)
            if (lane.settings.follows_master)
                follow(document, lane);
    });
}

bool isPixelCount(Document& document, double pixels) {
    const bool is_count = std::isfinite(pixels) && pixels > 0.0;
    if (!is_count)
        warn(document, "a target in pixels must be above 0; nothing changed");
    return is_count;
}

void run(Document& document, const SetLanePixels& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    if (!lane || !isPixelCount(document, command.pixels))
        return;
    edit(document, "Set target", command.drag, [&] {
        lane->settings.error_px = command.pixels;
        lane->settings.position.reset();
        lane->settings.follows_master = false;
        followView(document);
    });
}

void run(Document& document, const SetMasterPixels& command) {
    if (!isPixelCount(document, command.pixels))
        return;
    edit(document, "Set all targets", command.drag, [&] {
        document.master_px = command.pixels;
        followView(document);
        for (Lane& lane : document.lanes)
            if (lane.settings.follows_master)
                follow(document, lane);
    });
}

void run(Document& document, const FollowMaster& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    if (!lane)
        return;
    edit(document, command.follows ? "Follow master" : "Unlink from master", 0, [&] {
        if (command.follows)
            follow(document, *lane);
        else
            lane->settings.follows_master = false;
    });
}

void run(Document& document, const SetOrdering& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    if (!lane)
        return;
    edit(document, "Set ordering", 0, [&] {
        lane->settings.ordering = command.ordering;
        lane->settings.position.reset();
    });
}

void run(Document& document, const SetImportance& command) {
    if (!std::isfinite(command.importance) || !submeshesExist(document, command.submeshes))
        return;
    const double importance =
        std::clamp(command.importance, kMinimumImportance, kMaximumImportance);
    edit(document, "Set importance", command.drag, [&] {
        document.importance.resize(document.scene->submeshes.size(), 1.0);
        for (const std::uint32_t submesh : command.submeshes)
            document.importance[submesh] = importance;
        if (std::ranges::all_of(document.importance, [](double value) { return value == 1.0; }))
            document.importance.clear();
    });
}

void run(Document& document, const SetLocked& command) {
    if (!submeshesExist(document, command.submeshes))
        return;
    edit(document, command.locked ? "Lock" : "Unlock", 0, [&] {
        document.locked.resize(document.scene->submeshes.size(), false);
        for (const std::uint32_t submesh : command.submeshes)
            document.locked[submesh] = command.locked;
        if (std::ranges::none_of(document.locked, [](bool locked) { return locked; }))
            document.locked.clear();
    });
}

void run(Document& document, const SetExportOptions& command) {
    edit(document, "Set export options", 0, [&] { document.export_options = command.options; });
}

void run(Document& document, const StepCollapses& command) {
    Lane* lane = laneOrWarn(document, command.lane);
    if (!lane)
        return;
    const LaneStatus& status = lane->status;
    if (!status.source || !status.lod) {
        warn(document,
             fmt::format("{} has no collapses to step through yet", laneName(lane->settings)));
        return;
    }
    const std::uint64_t last = status.source->positionCount() - 1;
    const std::uint64_t now =
        std::min(lane->settings.position.value_or(status.lod->position), last);
    const std::uint64_t distance =
        command.steps < 0 ? std::uint64_t{0} - static_cast<std::uint64_t>(command.steps)
                          : static_cast<std::uint64_t>(command.steps);
    const std::uint64_t next =
        command.steps < 0 ? now - std::min(distance, now) : now + std::min(distance, last - now);
    if (next == now)
        return;
    edit(document, "Step collapses", command.drag, [&] {
        lane->settings.position = next;
        lane->settings.follows_master = false;
    });
}

void run(Document& document, const Undo&) {
    if (!document.history.canUndo())
        return;
    endSlides(document);
    restoreEdits(document, document.history.undo(editsOf(document)));
    ++document.revision;
}

void run(Document& document, const Redo&) {
    if (!document.history.canRedo())
        return;
    endSlides(document);
    restoreEdits(document, document.history.redo(editsOf(document)));
    ++document.revision;
}

void run(Document& document, const EndDrag&) {
    endSlides(document);
    document.history.endDrag();
}

// --- view ---

void run(Document& document, const SetActiveLane& command) {
    if (laneOrWarn(document, command.lane))
        document.active_lane = command.lane;
}

bool selectable(const Document& document, const SelectedItem& item) {
    if (!document.scene || item.submesh >= document.scene->submeshes.size())
        return false;
    return item.instance == kNone || item.instance < document.scene->instances.size();
}

void run(Document& document, const Select& command) {
    std::vector<SelectedItem>& selection = document.selection;
    if (command.mode == Select::Mode::Replace)
        selection.clear();
    for (const SelectedItem& item : command.items) {
        if (!selectable(document, item))
            continue;
        const auto place = std::ranges::lower_bound(selection, item);
        const bool present = place != selection.end() && *place == item;
        if (!present)
            selection.insert(place, item);
        else if (command.mode == Select::Mode::Toggle)
            selection.erase(place);
    }
}

bool finite(const CameraState& camera) {
    return std::isfinite(camera.azimuth_deg) && std::isfinite(camera.elevation_deg) &&
           std::isfinite(camera.distance) && isFinite(camera.target);
}

void run(Document& document, const SetCamera& command) {
    if (finite(command.camera) && command.camera.distance >= 0.0)
        document.camera = command.camera;
}

void run(Document& document, const FrameScene&) {
    document.camera = framed(document.camera, document.bounds);
}

void run(Document& document, const FrameSelection&) {
    Bounds bounds = selectionBounds(document);
    document.camera = framed(document.camera, bounds.empty ? document.bounds : bounds);
}

void run(Document& document, const SetView& command) {
    document.view = command.view;
}

void run(Document& document, const ClearMessages&) {
    document.messages.clear();
}

// --- requests: Session's ---

void run(Document&, const OpenScene&) {}

void run(Document&, const OpenSample&) {}

void run(Document&, const Export&) {}

void run(Document&, const MeasureLane&) {}

void run(Document&, const MeasureRates&) {}

void run(Document&, const CancelJob&) {}

void run(Document&, const RetryLane&) {}

} // namespace

void applyCommand(Document& document, const Command& command) {
    std::visit([&document](const auto& value) { run(document, value); }, command);
}

} // namespace lodestone
