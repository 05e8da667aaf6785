#pragma once
// The lanes' pictures in the window: which LOD or draft of it each view shows, drawn a few a frame.
// Main thread, context current.
#include "app/drafts.h"
#include "app/main/picture_differences.h"
#include "app/session.h"
#include "render/view_set.h"
#include "ui/window_state.h"

#include <chrono>
#include <map>

namespace lodestone {

class LanePictures {
public:
    using Clock = std::chrono::steady_clock;

    LanePictures(const GlContext& context, const Renderer& renderer);

    // Takes in the shape of the views, before framedCamera() and draw(). Returns whether they have
    // another one than when the camera was made to show everything, and it stands there still.
    bool noteShape(const Document& document, std::span<const ui::ViewRequest> views);

    // Goes on drawing what the views should show; tells the session what lanes cost and what went
    // wrong. The more of the frame has passed since it began, the less is drawn.
    // Returns whether any picture is another than before.
    bool
    draw(Session& session, std::span<const ui::ViewRequest> views, Clock::time_point frame_began);

    std::span<const ui::LanePicture> shown() const { return shown_; }

    // Some picture can be drawn further at once.
    bool stale() const { return stale_; }

    // Some picture waits for another thread: draw again soon.
    bool waiting() const { return waiting_; }

    // Every view shows what it should, nothing is a draft.
    bool final() const;

    // When the next draft is to be refined, if that is after `now`; else `latest`.
    Clock::time_point nextRefinement(Clock::time_point now, Clock::time_point latest) const;

    // What is seen at a point of a lane's view (0..1 from the left and from the top), in the
    // original's numbering; a lane of another scene's answer is that of one which shows it.
    std::optional<SelectedItem>
    pick(const Document& document, LaneId lane, const glm::dvec2& point) const;

    // The same for a box of the view; a submesh of which every instance is in it stands as one.
    std::vector<SelectedItem>
    pickBox(const Document& document, LaneId lane, const PickBox& box) const;

    // The camera turned as it is, near enough that the part, or the whole scene if it is empty,
    // fills the views.
    CameraState framedCamera(const Document& document, const Bounds& part);

private:
    std::vector<ViewSet::Wanted> wantedPictures(const Document& document,
                                                std::span<const ui::ViewRequest> views);
    bool isBlank(LaneId lane) const; // its view has no picture yet
    std::shared_ptr<const Lod> fullOriginal(const Document& document);
    // The lane itself or, if it shows another scene, one in view that shows the original's.
    LaneId laneToPickFrom(const Document& document, LaneId lane) const;
    void addReference(const Document& document, std::vector<ViewSet::Wanted>& wanted);
    void compare(Session& session, std::span<const ViewSet::Picture> drawn);
    void measureNext(Session& session);
    void noteMotion(const Document& document);
    bool take(Session& session, const std::vector<ViewSet::Picture>& drawn);

    ViewSet pictures_;
    Drafts drafts_;
    std::vector<ui::LanePicture> shown_;
    PictureDifferences differences_;
    std::shared_ptr<const Lod> reference_lod_; // full, of reference_scene_
    ScenePtr reference_scene_;

    struct Measuring {
        LaneId lane = kNoLane;
        std::uint64_t lod_revision = 0;
        std::uint64_t warm_up_frames = 0;
        std::uint64_t frames = 0;
        double total_ms = 0.0; // of the counted frames
        Clock::time_point begun;
    };

    Measuring measuring_;
    ScenePtr framed_scene_;
    FramePoints frame_points_; // of framed_scene_
    double view_aspect_ = 1.0;
    CameraState framed_camera_; // it showed everything
    double framed_aspect_ = 1.0;
    CameraState seen_camera_;
    DisplayOptions seen_view_;
    std::map<LaneId, std::uint64_t> seen_lods_;    // lod_revision
    std::map<LaneId, Clock::time_point> rests_at_; // drafts until then
    bool stale_ = false;
    bool waiting_ = false;
    bool shows_draft_ = false;
};

} // namespace lodestone
