#include "render/pick_box.h"

#include "render/gpu_scene_state.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <tuple>

namespace lodestone {

namespace {

bool isIn(const PickBox& box, const glm::dvec4& clip) {
    if (!(clip.w > 0.0))
        return false;
    const glm::dvec2 place(0.5 + 0.5 * clip.x / clip.w, 0.5 - 0.5 * clip.y / clip.w);
    return place.x >= box.min.x && place.x <= box.max.x && place.y >= box.min.y &&
           place.y <= box.max.y;
}

bool anyIn(const PickBox& box, const Geometry& geometry, const glm::dmat4& clip_from_local) {
    return std::ranges::any_of(geometry.positions, [&](const glm::vec3& position) {
        return isIn(box, clip_from_local * glm::dvec4(position, 1.0));
    });
}

} // namespace

std::vector<Highlight> pickBox(const View::Input& input, const PickBox& box) {
    std::vector<Highlight> picked;
    if (input.scene == nullptr || input.lod == nullptr || !input.lod->valid())
        return picked;
    const GpuSceneState& scene = input.scene->state();
    const glm::dmat4 clip_from_world =
        projectionMatrix(input.camera, input.size.aspect()) * viewMatrix(input.camera);
    for (const DrawItem& item : input.lod->state()->items) {
        if (!scene.hidden.empty() && scene.hidden[item.submesh])
            continue;
        const auto& order = item.instances->order;
        const std::uint32_t begin = scene.submeshes[item.submesh].range.begin;
        const auto instance_at = [&](std::size_t at) {
            return order ? (*order)[at] : begin + static_cast<std::uint32_t>(at);
        };
        std::vector<std::uint8_t> is_in(item.kept_instances);
        tbb::parallel_for(std::size_t{0}, is_in.size(), [&](std::size_t at) {
            const glm::dmat4& transform = scene.scene->instances[instance_at(at)].transform;
            is_in[at] = anyIn(box, *item.geometry->source, clip_from_world * transform) ? 1 : 0;
        });
        for (std::size_t at = 0; at < is_in.size(); ++at)
            if (is_in[at] != 0)
                picked.push_back({item.submesh, instance_at(at)});
    }
    const auto place = [](const Highlight& item) { return std::tie(item.submesh, item.instance); };
    std::ranges::sort(picked, {}, place);
    picked.erase(std::unique(picked.begin(), picked.end()), picked.end());
    return picked;
}

} // namespace lodestone
