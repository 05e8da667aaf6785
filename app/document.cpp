#include "app/document.h"

#include "app/scene_texels.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lodestone {

namespace {

constexpr std::size_t kMaximumMessages = 200;
constexpr std::array<std::string_view, 3> kFirstLanes = {"", "ias", "quadric"};

} // namespace

std::string_view jobKindName(JobKind kind) {
    constexpr std::array<std::string_view, 7> kNames = {
        "load", "prepare", "export", "measure", "predict", "error map", "texture"};
    return kNames.at(static_cast<std::size_t>(kind));
}

Lane* Document::findLane(LaneId id) {
    const auto found = std::ranges::find(lanes, id, &Lane::id);
    return found == lanes.end() ? nullptr : &*found;
}

const Lane* Document::findLane(LaneId id) const {
    const auto found = std::ranges::find(lanes, id, &Lane::id);
    return found == lanes.end() ? nullptr : &*found;
}

void report(Document& document, Severity severity, std::string text) {
    std::uint64_t sequence = 1;
    for (const Message& message : document.messages)
        sequence = std::max(sequence, message.sequence + 1);
    const auto same = std::ranges::find_if(document.messages, [&](const Message& message) {
        return message.severity == severity && message.text == text;
    });
    if (same != document.messages.end()) {
        ++same->count;
        same->sequence = sequence;
        std::rotate(same, same + 1, document.messages.end());
        return;
    }
    if (document.messages.size() >= kMaximumMessages)
        document.messages.erase(document.messages.begin());
    document.messages.push_back({severity, std::move(text), 1, sequence});
}

const Message* topMessage(const Document& document) {
    const auto rank = [](const Message& message) {
        return std::pair(message.severity, message.sequence);
    };
    const auto top = std::ranges::max_element(document.messages, {}, rank);
    return top == document.messages.end() ? nullptr : &*top;
}

ScheduleOptions scheduleOptions(const Document& document, const LaneSettings& settings) {
    ScheduleOptions options;
    options.ordering = settings.ordering;
    if (settings.algorithm && !settings.algorithm->expands) {
        options.importance = document.importance;
        options.locked = document.locked;
    }
    return options;
}

LoadedScene describeScene(ScenePtr scene, std::filesystem::path path) {
    LoadedScene loaded;
    loaded.counts = countScene(*scene);
    loaded.bounds = robustWorldBounds(*scene);
    loaded.texels_per_unit = texelsPerUnit(*scene);
    loaded.scene = std::move(scene);
    loaded.path = std::move(path);
    return loaded;
}

Lane makeLane(Document& document, const Algorithm* algorithm) {
    Lane lane;
    lane.id = document.next_lane_id++;
    lane.settings.algorithm = algorithm;
    lane.settings.target = document.master;
    lane.settings.error_px = document.master_px;
    lane.settings.colour = freeLaneColour(document.lanes, algorithm, kNoLane);
    return lane;
}

LaneId startingLane(const Document& document) {
    if (document.lanes.empty())
        return kNoLane;
    const auto rank = [](const Lane& lane) {
        if (!lane.settings.algorithm)
            return 2;
        return lane.settings.algorithm->id == "ias" ? 0 : 1;
    };
    return std::ranges::min_element(document.lanes, {}, rank)->id;
}

void resetDocument(Document& document, LoadedScene loaded) {
    document.scene = std::move(loaded.scene);
    document.path = std::move(loaded.path);
    document.counts = loaded.counts;
    document.bounds = loaded.bounds;
    document.texels_per_unit = loaded.texels_per_unit;
    document.load_state = LoadState::Loaded;
    document.lanes.clear();
    document.master = Target{Target::Kind::Ratio, 0.2};
    document.master_px.reset();
    document.importance.clear();
    document.locked.clear();
    document.selection.clear();
    document.last_export.reset();
    document.history = History();
    document.camera = framed(CameraState{}, document.bounds);
    for (const std::string_view id : kFirstLanes) {
        const Algorithm* algorithm = id.empty() ? nullptr : findAlgorithm(id);
        if (!algorithm && !id.empty())
            continue;
        document.lanes.push_back(makeLane(document, algorithm));
    }
    document.active_lane = startingLane(document);
    ++document.revision;
    document.saved_revision = document.revision;
    ++document.scene_revision;
}

namespace {

void addCorners(Bounds& bounds, const Bounds& local, const glm::dmat4& transform) {
    if (local.empty)
        return;
    for (unsigned corner = 0; corner < 8; ++corner) {
        const glm::dvec4 point((corner & 1u) != 0 ? local.max.x : local.min.x,
                               (corner & 2u) != 0 ? local.max.y : local.min.y,
                               (corner & 4u) != 0 ? local.max.z : local.min.z,
                               1.0);
        bounds.add(glm::dvec3(transform * point));
    }
}

} // namespace

Bounds selectionBounds(const Document& document) {
    Bounds bounds;
    if (!document.scene)
        return bounds;
    const Scene& scene = *document.scene;
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    for (const SelectedItem& item : document.selection) {
        const Bounds local = localBounds(scene.submeshes[item.submesh]);
        InstanceRange range = ranges[item.submesh];
        if (item.instance != kNone)
            range = {item.instance, item.instance + 1};
        for (std::uint32_t index = range.begin; index < range.end; ++index)
            addCorners(bounds, local, scene.instances[index].transform);
    }
    return bounds;
}

double errorOfPixels(const Document& document, double pixels) {
    const double shown = 2.0 * document.camera.distance * std::tan(kVerticalFovRad * 0.5);
    const double pixel_size = shown / std::max(document.view_side_px, 1.0);
    const double diagonal = document.bounds.diagonal();
    return diagonal > 0.0 ? 100.0 * pixels * pixel_size / diagonal : 0.0;
}

void followView(Document& document) {
    const auto follow = [&](Target& target, const std::optional<double>& pixels) {
        if (pixels)
            target = {Target::Kind::Error, errorOfPixels(document, *pixels)};
    };
    follow(document.master, document.master_px);
    for (Lane& lane : document.lanes)
        follow(lane.settings.target, lane.settings.error_px);
}

Edits editsOf(const Document& document) {
    Edits edits;
    edits.lanes.reserve(document.lanes.size());
    for (const Lane& lane : document.lanes)
        edits.lanes.push_back({lane.id, lane.settings});
    edits.master = document.master;
    edits.master_px = document.master_px;
    edits.importance = document.importance;
    edits.locked = document.locked;
    edits.export_options = document.export_options;
    return edits;
}

void restoreEdits(Document& document, const Edits& edits) {
    std::vector<Lane> lanes;
    lanes.reserve(edits.lanes.size());
    for (const EditedLane& edited : edits.lanes) {
        Lane lane;
        if (Lane* existing = document.findLane(edited.id))
            lane = std::move(*existing);
        lane.id = edited.id;
        if (lane.settings.algorithm != edited.settings.algorithm ||
            lane.settings.parameters != edited.settings.parameters)
            ++lane.revision;
        lane.settings = edited.settings;
        lanes.push_back(std::move(lane));
    }
    document.lanes = std::move(lanes);
    document.master = edits.master;
    document.master_px = edits.master_px;
    document.importance = edits.importance;
    document.locked = edits.locked;
    document.export_options = edits.export_options;
    if (!document.findLane(document.active_lane))
        document.active_lane = startingLane(document);
}

} // namespace lodestone
