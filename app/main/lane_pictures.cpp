#include "app/main/lane_pictures.h"

#include "app/main/texture_id.h"
#include "app/main/view_values.h"
#include "app/scene_texels.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

constexpr double kPicturesDoneMs = 45.0; // after the frame began; what is left is for its output
constexpr double kSoftwareMsPerTriangle = 0.0004; // llvmpipe on two busy cores
constexpr std::chrono::milliseconds kRest{150};   // no input for so long: refine
constexpr std::chrono::milliseconds kSoon{30};    // the same after a view's first draft

} // namespace

LanePictures::LanePictures(const GlContext& context, const Renderer& renderer)
    : pictures_(renderer), drafts_(context.info().is_software ? kSoftwareMsPerTriangle : 0.0) {}

std::vector<ViewSet::Wanted> LanePictures::wantedPictures(const Document& document,
                                                          std::span<const ui::ViewRequest> views) {
    const bool heat = document.view.compare == CompareMode::HeatMap;
    const bool differences = document.view.compare == CompareMode::Difference;
    const Clock::time_point now = Clock::now();
    std::vector<Highlight> highlighted;
    for (const SelectedItem& item : document.selection)
        highlighted.push_back({item.submesh, item.instance});
    std::vector<ViewSet::Wanted> wanted;
    for (const ui::ViewRequest& view : views) {
        const Lane* const lane = document.findLane(view.lane);
        if (!lane)
            continue;
        const LaneStatus& status = lane->status;
        // Pictures that are compared have one size: cells of a grid differ by a pixel.
        const ui::ViewRequest& sized = differences ? views.front() : view;
        Clock::time_point& rests_at = rests_at_[lane->id];
        if (isBlank(lane->id)) // a draft now is worth more than the whole picture later
            rests_at = std::max(rests_at, now + kSoon);
        const bool drafted = !differences && now < rests_at;
        const std::shared_ptr<const Lod> draft =
            drafted ? drafts_.draftOf(document, *lane) : nullptr;
        const DrawnLod drawn = drawnLod(status);
        DrawnLod shown = drawn;
        if (draft)
            shown = {status.scene, status.lod};
        if (heat && status.error_map.lod)
            shown = {status.scene, status.error_map.lod};
        wanted.push_back(
            {view.lane, shown.scene, shown.lod, draft, {sized.width_px, sized.height_px}, {}});
        // Where a draft shows the scene without its transferred textures, those come back at rest.
        wanted.back().kept_scene = shown.scene == drawn.scene ? status.scene : drawn.scene;
        if (differences || highlighted.empty() || !shown.scene)
            continue;
        wanted.back().highlighted = highlighted;
        if (shown.scene != document.scene) { // it has dissolved submeshes and instances
            if (draft) { // marks of the whole original would make it as slow as what it stands for
                wanted.back().highlighted.clear();
                continue;
            }
            wanted.back().marked_scene = document.scene;
            wanted.back().marked_lod = fullOriginal(document);
        }
    }
    return wanted;
}

bool LanePictures::isBlank(LaneId lane) const {
    const auto shown = std::ranges::find(shown_, lane, &ui::LanePicture::lane);
    return shown == shown_.end() || shown->texture == nullptr;
}

std::shared_ptr<const Lod> LanePictures::fullOriginal(const Document& document) {
    if (reference_scene_ != document.scene) {
        reference_scene_ = document.scene;
        reference_lod_ = std::make_shared<const Lod>(fullLod(*document.scene));
    }
    return reference_lod_;
}

// The original's picture, where a difference from it is wanted and no lane in view shows it.
void LanePictures::addReference(const Document& document, std::vector<ViewSet::Wanted>& wanted) {
    if (document.view.compare != CompareMode::Difference || wanted.empty() || !document.scene)
        return;
    for (const ViewSet::Wanted& lane : wanted)
        if (!document.findLane(lane.key)->settings.algorithm)
            return;
    wanted.push_back(
        {kNoLane, document.scene, fullOriginal(document), nullptr, wanted.front().size, {}});
}

bool LanePictures::noteShape(const Document& document, std::span<const ui::ViewRequest> views) {
    constexpr double kSameShape = 0.02; // cells of a grid differ by a pixel
    if (views.empty())
        return false;
    view_aspect_ = ViewSize{views.front().width_px, views.front().height_px}.aspect();
    return document.camera == framed_camera_ &&
           std::abs(view_aspect_ - framed_aspect_) > kSameShape * framed_aspect_;
}

bool LanePictures::draw(Session& session,
                        std::span<const ui::ViewRequest> views,
                        Clock::time_point frame_began) {
    const std::chrono::duration<double, std::milli> passed = Clock::now() - frame_began;
    const double budget_ms = std::clamp(kPicturesDoneMs - passed.count(), 0.0, Drafts::kPicturesMs);
    const Document& document = session.document();
    noteMotion(document);
    std::vector<ViewSet::Wanted> wanted = wantedPictures(document, views);
    addReference(document, wanted);
    if (!views.empty())
        session.setViewSide(std::min(views.front().width_px, views.front().height_px));
    const auto drawn = pictures_.draw(
        wanted,
        orbitCamera(document.camera, document.bounds, view_aspect_),
        viewOptions(document.view, {errorMapFull(document), texelsFull(document.texels_per_unit)}),
        budget_ms);
    if (!drawn) {
        session.reportError(drawn.error().message); // repeats are counted, not listed again
        return false;
    }
    const bool changed = take(session, *drawn);
    compare(session, *drawn);
    measureNext(session);
    return changed;
}

// Puts the differences in the place of the pictures.
void LanePictures::compare(Session& session, std::span<const ViewSet::Picture> drawn) {
    const Document& document = session.document();
    if (document.view.compare != CompareMode::Difference) {
        differences_.clear(session);
        return;
    }
    const auto is_reference = [&](const ViewSet::Picture& picture) {
        const Lane* const lane = document.findLane(picture.key);
        return !lane || !lane->settings.algorithm;
    };
    const auto reference = std::ranges::find_if(drawn, is_reference);
    if (reference == drawn.end())
        return;
    differences_.update(session, pictures_, drawn, *reference, document.view.colors);
    waiting_ = waiting_ || differences_.busy();
    for (ui::LanePicture& picture : shown_) {
        const Lane* const lane = document.findLane(picture.lane);
        const auto difference = differences_.of(picture.lane);
        if (!lane || !lane->settings.algorithm)
            continue;
        picture.draft = picture.draft || !difference.current;
        if (difference.texture != 0)
            picture.texture = textureId(difference.texture);
    }
}

// A little more of the papers' protocol, for the first lane that is to be measured.
void LanePictures::measureNext(Session& session) {
    constexpr std::uint64_t kWarmUpFrames = 100;
    constexpr std::uint64_t kFrames = 1000;
    constexpr double kSliceSeconds = 0.04;
    constexpr std::chrono::seconds kLongest{4}; // slow renderers would need minutes
    const Document& document = session.document();
    for (const Lane& lane : document.lanes) {
        if (!lane.status.rate_wanted)
            continue;
        const auto shown = std::ranges::find(shown_, lane.id, &ui::LanePicture::lane);
        if (shown == shown_.end()) {
            session.setRate(lane.id, std::nullopt); // not in view
            continue;
        }
        stale_ = true; // there is more to do
        if (shown->draft)
            return;
        if (measuring_.lane != lane.id || measuring_.lod_revision != lane.status.lod_revision)
            measuring_ = {lane.id, lane.status.lod_revision, 0, 0, 0.0, Clock::now()};
        const auto slice = pictures_.measure(lane.id, {0, kFrames, kSliceSeconds});
        if (!slice) {
            session.reportError(slice.error().message);
            session.setRate(lane.id, std::nullopt);
            return;
        }
        const bool warm = measuring_.warm_up_frames >= kWarmUpFrames ||
                          Clock::now() - measuring_.begun > kLongest / 4;
        if (!warm) {
            measuring_.warm_up_frames += slice->frames;
            return;
        }
        measuring_.frames += slice->frames;
        measuring_.total_ms += slice->mean_ms * static_cast<double>(slice->frames);
        const bool late = measuring_.frames > 0 && Clock::now() - measuring_.begun > kLongest;
        if (measuring_.frames >= kFrames || late) {
            const auto frames = static_cast<double>(measuring_.frames);
            session.setRate(lane.id, MeasuredRate{measuring_.total_ms / frames, measuring_.frames});
            measuring_ = {};
        }
        return;
    }
}

LaneId LanePictures::laneToPickFrom(const Document& document, LaneId lane_id) const {
    // What a lane's status names may not be drawn yet.
    const auto shows_original = [&](LaneId id) {
        return document.scene && pictures_.pickedScene(id) == document.scene.get();
    };
    if (shows_original(lane_id))
        return lane_id;
    const auto other = std::ranges::find_if(
        shown_, [&](const ui::LanePicture& picture) { return shows_original(picture.lane); });
    return other == shown_.end() ? kNoLane : other->lane;
}

std::optional<SelectedItem>
LanePictures::pick(const Document& document, LaneId lane, const glm::dvec2& point) const {
    const LaneId asked = laneToPickFrom(document, lane);
    const std::optional<Picked> picked =
        asked == kNoLane ? std::nullopt : pictures_.pick(asked, point);
    if (!picked)
        return std::nullopt;
    return SelectedItem{picked->submesh, picked->instance};
}

std::vector<SelectedItem>
LanePictures::pickBox(const Document& document, LaneId lane, const PickBox& box) const {
    const LaneId asked = laneToPickFrom(document, lane);
    if (asked == kNoLane || !document.scene)
        return {};
    const std::vector<Highlight> picked = pictures_.pickBox(asked, box);
    const std::vector<InstanceRange> ranges = instanceRanges(*document.scene);
    std::vector<SelectedItem> items;
    for (auto begin = picked.begin(); begin != picked.end();) {
        const auto end = std::ranges::find_if(
            begin, picked.end(), [&](const Highlight& at) { return at.submesh != begin->submesh; });
        if (static_cast<std::size_t>(end - begin) == ranges[begin->submesh].size())
            items.push_back({begin->submesh, kNone});
        else
            for (auto at = begin; at != end; ++at)
                items.push_back({at->submesh, at->instance});
        begin = end;
    }
    return items;
}

// Lanes whose picture becomes another one rest a moment later: all of them when the camera or the
// display changes, else those whose LOD does.
void LanePictures::noteMotion(const Document& document) {
    const bool all = !(document.camera == seen_camera_) || !(document.view == seen_view_);
    seen_camera_ = document.camera;
    seen_view_ = document.view;
    for (const Lane& lane : document.lanes) {
        std::uint64_t& seen = seen_lods_[lane.id];
        if (all || seen != lane.status.lod_revision)
            rests_at_[lane.id] = Clock::now() + kRest;
        seen = lane.status.lod_revision;
    }
    const auto gone = [&](const auto& entry) { return !document.findLane(entry.first); };
    std::erase_if(seen_lods_, gone);
    std::erase_if(rests_at_, gone);
}

bool LanePictures::take(Session& session, const std::vector<ViewSet::Picture>& drawn) {
    const bool has_reference = !drawn.empty() && drawn.back().key == kNoLane;
    bool changed = drawn.size() != shown_.size() + (has_reference ? 1 : 0);
    shown_.clear();
    stale_ = false;
    waiting_ = false;
    shows_draft_ = false;
    for (const ViewSet::Picture& picture : drawn) {
        changed = changed || picture.drew;
        stale_ = stale_ || (picture.stale && !picture.on_its_way);
        waiting_ = waiting_ || picture.on_its_way;
        shows_draft_ = shows_draft_ || picture.draft;
        if (const Lane* const lane = session.document().findLane(picture.key);
            lane && picture.drew) {
            drafts_.setCosts(*lane, picture.cost_ms, picture.draft_cost_ms);
            if (picture.cost_ms > 0.0)
                session.setFrameTime(picture.key, picture.cost_ms);
        }
        if (picture.key == kNoLane)
            continue; // the reference
        shown_.push_back({picture.key,
                          textureId(picture.texture),
                          picture.stale || picture.draft,
                          picture.version});
    }
    drafts_.forgetOthers(session.document());
    return changed;
}

bool LanePictures::final() const {
    return !shown_.empty() && std::ranges::all_of(shown_, [](const ui::LanePicture& picture) {
        return picture.texture != nullptr && !picture.draft;
    });
}

LanePictures::Clock::time_point LanePictures::nextRefinement(Clock::time_point now,
                                                             Clock::time_point latest) const {
    for (const auto& [lane, rests_at] : rests_at_)
        if (shows_draft_ && rests_at > now)
            latest = std::min(latest, rests_at);
    return latest;
}

CameraState LanePictures::framedCamera(const Document& document, const Bounds& part) {
    if (framed_scene_ != document.scene) {
        framed_scene_ = document.scene;
        frame_points_ = framePoints(*document.scene, document.bounds);
    }
    OrbitCamera camera = orbitCamera(document.camera, document.bounds, view_aspect_);
    if (part.empty)
        frameCamera(camera, frame_points_, view_aspect_);
    else
        frameSelection(camera, part, view_aspect_);
    CameraState framed = document.camera;
    framed.target = camera.target;
    framed.distance = camera.distance;
    if (part.empty) {
        framed_camera_ = framed;
        framed_aspect_ = view_aspect_;
    }
    return framed;
}

} // namespace lodestone
