#pragma once
// The part of putting a scene on the GPU that needs no GL: any thread.
#include "scene/scene.h"

#include <memory>

namespace lodestone {

struct PreparedScene; // render/prepared_scene_parts.h, inside this folder
using PreparedScenePtr = std::shared_ptr<const PreparedScene>;

// Bounds, frames of the submeshes, decoded images. max_texture_size_px: of the GPU (GlInfo).
// Any thread; parallel. May throw std::bad_alloc.
// Cost: O(vertices + instances + pixels).
PreparedScenePtr prepareScene(ScenePtr scene, int max_texture_size_px);

// About what prepareScene() costs, in vertices: for deciding whether a frame can wait for it.
std::uint64_t preparationWork(const Scene& scene);

} // namespace lodestone
