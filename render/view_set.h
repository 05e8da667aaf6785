#pragma once
// The pictures of several lanes that share one camera: GPU scenes by scene, one view a lane, drawn
// a few a call so that no frame waits for all of them. Main thread, context current.
#include "render/pick.h"
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
        ViewSize size;
    };

    struct Picture {
        std::uint32_t key = 0;
        TextureHandle texture = 0; // of the last draw, perhaps of an older state
        bool stale = true;         // not yet what was wanted
        bool drew = false;         // by this call
        double cost_ms = 0.0;      // of its last measured draw; 0: unknown
    };

    // Draws stale pictures, the one that waits longest first, until budget_ms is spent; always at
    // least one. Lanes that are not wanted any more lose their pictures, scenes that no lane wants
    // their GPU memory. Result: one picture for each wanted lane, in order.
    // Errors: those of GpuScene and View.
    Result<std::vector<Picture>> draw(std::span<const Wanted> wanted,
                                      const OrbitCamera& camera,
                                      const ViewOptions& options,
                                      double budget_ms);

    // What was last drawn under a point of a lane's picture (see pick.h). nullopt: nothing.
    std::optional<Picked> pick(std::uint32_t key, const glm::dvec2& point) const;

private:
    struct Item {
        explicit Item(View made) : view(std::move(made)) {}

        View view;
        LodHandle handle;
        const Scene* scene = nullptr; // drawn last
        std::shared_ptr<const Lod> lod;
        OrbitCamera camera;
        ViewOptions options;
        ViewSize size;
        std::uint64_t drawn_at = 0; // turn of the last draw
        double cost_ms = 0.0;
        bool drawn = false;
    };

    Result<Item*> itemOf(std::uint32_t key);
    Result<GpuScene*> sceneOf(const ScenePtr& scene);
    void forgetUnwanted(std::span<const Wanted> wanted);
    Result<void> drawItem(Item& item,
                          const Wanted& wanted,
                          const OrbitCamera& camera,
                          const ViewOptions& options);

    Renderer renderer_;
    std::map<std::uint32_t, Item> items_;
    std::map<const Scene*, GpuScene> scenes_; // each keeps its scene alive
    std::uint64_t turn_ = 0;
};

} // namespace lodestone
