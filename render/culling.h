#pragma once
// Inside render/ only: which instances a camera can see. Found once for a picture; a still frame
// costs nothing.
#include "render/gpu_scene_state.h"
#include "render/view.h"

#include <map>

namespace lodestone {

struct SeenInstances {
    const InstanceBuffer* buffer = nullptr; // the item's own, or those that are seen alone
    std::uint32_t count = 0;                // the first that many of it
};

class Culling {
public:
    // Before the draws of a picture: what was found for another LOD, camera or size is dropped.
    void prepare(const View::Input& input);

    // By bounding spheres; all, where the whole scene is in view or nearly all are. Conservative:
    // never leaves out what would show. Cost: O(kept instances) once, parallel, and a copy of the
    // seen ones to the GPU.
    // item: in LodState::items.
    SeenInstances seen(std::size_t item, const View::Input& input);

private:
    struct Found {
        bool all = true;
        std::shared_ptr<InstanceBuffer> buffer; // unless all; null: none
    };

    Found find(const DrawItem& item, const View::Input& input) const;

    const GpuSceneState* scene_ = nullptr;
    std::uint64_t lod_revision_ = 0;
    OrbitCamera camera_;
    ViewSize size_{0, 0};
    bool sees_all_ = true;
    std::array<glm::dvec4, 5> planes_{}; // world; inside where the product with (p, 1) is >= 0
    std::map<std::size_t, Found> found_; // by place in LodState::items
};

} // namespace lodestone
