#include "app/main/lane_pictures.h"

#include "app/main/view_values.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr double kPictureBudgetMs = 25.0;
constexpr double kSoftwareMsPerTriangle = 0.0002; // llvmpipe on two cores
constexpr std::chrono::milliseconds kRest{150};   // no input for so long: refine

} // namespace

LanePictures::LanePictures(const GlContext& context, const Renderer& renderer)
    : pictures_(renderer), drafts_(context.info().is_software ? kSoftwareMsPerTriangle : 0.0) {}

bool LanePictures::draw(Session& session, std::span<const ui::ViewRequest> views) {
    const Document& document = session.document();
    noteMotion(document);
    const Clock::time_point now = Clock::now();
    std::vector<ViewSet::Wanted> wanted;
    for (const ui::ViewRequest& view : views)
        if (const Lane* const lane = document.findLane(view.lane))
            wanted.push_back(
                {view.lane,
                 lane->status.scene,
                 lane->status.lod,
                 now < rests_at_[lane->id] ? drafts_.draftOf(document, *lane) : nullptr,
                 {view.width_px, view.height_px}});
    view_aspect_ =
        views.empty() ? 1.0 : ViewSize{views.front().width_px, views.front().height_px}.aspect();
    const auto drawn = pictures_.draw(wanted,
                                      orbitCamera(document.camera, document.bounds, view_aspect_),
                                      viewOptions(document.view),
                                      kPictureBudgetMs);
    if (!drawn) {
        session.reportError(drawn.error().message); // repeats are counted, not listed again
        return false;
    }
    return take(session, *drawn);
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
    bool changed = drawn.size() != shown_.size();
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
        shown_.push_back(
            {picture.key,
             // NOLINTNEXTLINE(performance-no-int-to-ptr): what Dear ImGui calls a texture
             reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(picture.texture)),
             picture.stale || picture.draft});
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
    return framed;
}

} // namespace lodestone
