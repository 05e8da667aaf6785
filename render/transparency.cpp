#include "render/transparency.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::uint64_t kMostSorted = 4096;

} // namespace

bool isBlended(const DrawItem& item, const GpuSceneState& scene, Shading shading) {
    return (shading == Shading::Lit || shading == Shading::Flat) &&
           (scene.materials[item.material].features & kAlphaBlend) != 0;
}

std::vector<BlendedInstance> backToFront(const View::Input& input) {
    const GpuSceneState& scene = input.scene->state();
    std::vector<const DrawItem*> items;
    std::uint64_t instance_count = 0;
    for (const DrawItem& item : input.lod->state()->items) {
        const bool hidden = !scene.hidden.empty() && scene.hidden[item.submesh];
        if (hidden || !isBlended(item, scene, input.options.shading))
            continue;
        items.push_back(&item);
        instance_count += item.kept_instances;
    }
    std::vector<BlendedInstance> sorted;
    if (instance_count > kMostSorted)
        return sorted;
    const glm::dmat4 view = viewMatrix(input.camera);
    for (const DrawItem* item : items) {
        const GpuSubmesh& submesh = scene.submeshes[item->submesh];
        const auto& order = item->instances->order;
        for (std::uint32_t place = 0; place < item->kept_instances; ++place) {
            const std::uint32_t id = order ? (*order)[place] : submesh.range.begin + place;
            const glm::dvec4 middle =
                scene.transform(id) * glm::dvec4(item->geometry->source_center, 1.0);
            sorted.push_back({item, place, -(view * middle).z});
        }
    }
    std::stable_sort(
        sorted.begin(), sorted.end(), [](const BlendedInstance& a, const BlendedInstance& b) {
            return a.depth > b.depth;
        });
    return sorted;
}

} // namespace lodestone
