#pragma once
// The pictures of several lanes that share one camera: GPU scenes by scene, one view a lane, drawn
// a few a call so that no frame waits for all of them. Main thread, context current.
#include "render/delivery.h"
#include "render/pick.h"
#include "render/pick_box.h"
#include "render/view.h"

#include <map>
#include <span>

namespace lodestone {

class ViewSet {
public:
    explicit ViewSet(Renderer renderer) : renderer_(std::move(renderer)) {}

    // What one lane should look like.
    struct Wanted {
        std::uint32_t key = 0; // of the lane; keeps its picture between calls
        ScenePtr scene;        // null: no picture
        std::shared_ptr<const Lod> lod;
        // Of the same scene; drawn instead, with hard edges, while it is set: a coarser one while
        // the camera moves. Both stay on the GPU.
        std::shared_ptr<const Lod> draft;
        ViewSize size;
        std::vector<Highlight> highlighted; // in its scene
        // Set: highlighted are those of this LOD of another scene (see View::Input).
        ScenePtr marked_scene = nullptr;
        std::shared_ptr<const Lod> marked_lod = nullptr; // set as marked_scene is; one in all lanes
        ScenePtr kept_scene = nullptr; // stays on the GPU though it is not drawn: it may be soon
    };

    struct Picture {
        std::uint32_t key = 0;
        TextureHandle texture = 0;  // of the last draw, perhaps of an older state
        bool stale = true;          // not yet what was wanted
        bool on_its_way = false;    // stale, and drawing it waits for another thread
        bool draft = false;         // it shows a draft
        bool drew = false;          // by this call
        std::uint64_t version = 0;  // another for every complete draw
        double cost_ms = 0.0;       // of the last measured draw of its LOD; 0: unknown
        double draft_cost_ms = 0.0; // the same of its draft
    };

    // Draws stale pictures, cheap ones first and then the one that waits longest, until budget_ms
    // is spent; always goes on with at least one. Where the CPU draws, one that costs more than
    // the budget is drawn over several calls, and starts again if it changes before it is done;
    // but if no more than the camera moves and there is no draft, it is finished first.
    // Scenes and LODs that take long to bring to the GPU are packed on another thread and copied in
    // pieces; until they are there, pictures stay as they are.
    // Lanes that are not wanted any more lose their pictures, scenes that no lane wants their GPU
    // memory. Result: one picture for each wanted lane, in order. Errors: those of GpuScene and
    // View.
    Result<std::vector<Picture>> draw(std::span<const Wanted> wanted,
                                      const OrbitCamera& camera,
                                      const ViewOptions& options,
                                      double budget_ms);

    // The most that one call packs itself, in LodPackage::work() and preparationWork().
    static constexpr std::uint64_t kMostPackedPerCall = 150'000;

    // What the last call did beside drawing.
    struct CallWork {
        std::uint64_t packed = 0;       // <= kMostPackedPerCall
        std::uint64_t copied_bytes = 0; // <= Delivery::kCopiedPerStep
    };

    const CallWork& lastWork() const { return last_work_; }

    // Draws a lane again and again as it was last drawn (see View::measure). Blocks as long as the
    // options say, at least for a whole frame: in slices, frames take half as long again where the
    // CPU draws. Errors: Usage if it has no complete picture; those of View.
    Result<MeasureReport> measure(std::uint32_t key, const MeasureOptions& options);
    // Of a lane's last complete picture. Errors: as measure().
    Result<Pixels> readPixels(std::uint32_t key) const;

    // Of what was last drawn for a lane: whose submeshes and instances pick() names. null: nothing.
    const Scene* pickedScene(std::uint32_t key) const;

    // What was last drawn under a point of a lane's picture (see pick.h). nullopt: nothing.
    std::optional<Picked> pick(std::uint32_t key, const glm::dvec2& point) const;
    // What of it is in a box (see pick_box.h).
    std::vector<Highlight> pickBox(std::uint32_t key, const PickBox& box) const;

private:
    struct Item {
        explicit Item(View made) : view(std::move(made)) {}

        View view;

        struct Uploaded {
            LodHandle handle;
            std::shared_ptr<const Lod> lod;
            double cost_ms = 0.0;
        };

        const Uploaded& shown() const { return shows_draft ? draft : full; }

        Uploaded full;
        Uploaded draft;
        bool shows_draft = false;
        const Scene* scene = nullptr; // drawn last
        bool has_marks = false;       // of marks_
        OrbitCamera camera;
        ViewOptions options;
        ViewSize size;
        std::uint64_t drawn_at = 0; // turn of the last draw
        bool drawn = false;         // it has a picture, perhaps of another state
        bool complete = false;      // the picture shows what the members above say
    };

    Result<Item*> itemOf(std::uint32_t key);
    View::Input inputOf(const Item& item) const; // as it was last drawn
    Result<void> advanceDelivery(std::span<const Wanted> wanted);
    Result<bool> isSceneReady(const ScenePtr& scene);
    // Whether it can be drawn now; else it is brought to the GPU, once it is its turn.
    Result<bool> isReady(const Item& item, const Wanted& wanted);
    Result<bool> areMarksReady(const Wanted& wanted);
    bool takesNoLonger(std::uint64_t work);
    static bool isStale(const Item& item,
                        const Wanted& wanted,
                        const OrbitCamera& camera,
                        const ViewOptions& options);
    static bool isUnderWay(const Item& item, const Wanted& wanted, const ViewOptions& options);
    void forgetUnwanted(std::span<const Wanted> wanted);
    // Returns whether the picture is complete.
    Result<bool> drawItem(Item& item,
                          const Wanted& wanted,
                          const OrbitCamera& camera,
                          const ViewOptions& options,
                          double budget_ms);
    static double costOf(const Item& item, const Wanted& wanted); // 0: unknown

    Renderer renderer_;
    std::map<std::uint32_t, Item> items_;
    std::map<const Scene*, GpuScene> scenes_; // each keeps its scene alive
    Delivery delivery_;

    struct Marks { // what lanes of other scenes highlight
        LodHandle handle;
        std::shared_ptr<const Lod> lod;
        const Scene* scene = nullptr;
    };

    Marks marks_;
    CallWork last_work_;
    std::uint64_t turn_ = 0;
};

} // namespace lodestone
