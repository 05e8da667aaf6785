#include "render/view_set.h"

#include <algorithm>
#include <chrono>

namespace lodestone {

namespace {

double millisecondsSince(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
        .count();
}

} // namespace

Result<ViewSet::Item*> ViewSet::itemOf(std::uint32_t key) {
    if (const auto known = items_.find(key); known != items_.end())
        return &known->second;
    Result<View> view = View::create(renderer_);
    if (!view)
        return tl::unexpected(view.error());
    return &items_.emplace(key, Item(std::move(*view))).first->second;
}

Result<GpuScene*> ViewSet::sceneOf(const ScenePtr& scene) {
    if (const auto known = scenes_.find(scene.get()); known != scenes_.end())
        return &known->second;
    Result<GpuScene> created = GpuScene::create(renderer_, scene);
    if (!created)
        return tl::unexpected(created.error());
    return &scenes_.emplace(scene.get(), std::move(*created)).first->second;
}

void ViewSet::forgetUnwanted(std::span<const Wanted> wanted) {
    std::erase_if(items_, [&](const auto& entry) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const Wanted& lane) {
            return lane.key == entry.first;
        });
    });
    std::erase_if(scenes_, [&](const auto& entry) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const Wanted& lane) {
            return lane.scene.get() == entry.first;
        });
    });
}

Result<void> ViewSet::drawItem(Item& item,
                               const Wanted& wanted,
                               const OrbitCamera& camera,
                               const ViewOptions& options) {
    Result<GpuScene*> scene = sceneOf(wanted.scene);
    if (!scene)
        return tl::unexpected(scene.error());
    if (item.scene != wanted.scene.get())
        item.handle = LodHandle();
    if (!item.handle.valid() || item.lod != wanted.lod)
        if (const auto updated = (*scene)->update(item.handle, *wanted.lod); !updated)
            return tl::unexpected(updated.error());
    const Result<DrawReport> report =
        item.view.draw({*scene, &item.handle, camera, options, wanted.size});
    if (!report)
        return tl::unexpected(report.error());
    if (report->cost_known)
        item.cost_ms = report->cost_ms;
    item.scene = wanted.scene.get();
    item.lod = wanted.lod;
    item.camera = camera;
    item.options = options;
    item.size = wanted.size;
    item.drawn_at = ++turn_;
    item.drawn = true;
    return {};
}

Result<std::vector<ViewSet::Picture>> ViewSet::draw(std::span<const Wanted> wanted,
                                                    const OrbitCamera& camera,
                                                    const ViewOptions& options,
                                                    double budget_ms) {
    forgetUnwanted(wanted);
    std::vector<Picture> pictures(wanted.size());
    std::vector<std::pair<std::uint64_t, std::size_t>> queue; // turn of the last draw, place
    for (std::size_t at = 0; at < wanted.size(); ++at) {
        const Wanted& lane = wanted[at];
        pictures[at].key = lane.key;
        pictures[at].stale = false;
        if (!lane.scene || !lane.lod || lane.size.width_px < 1 || lane.size.height_px < 1)
            continue;
        const Result<Item*> item = itemOf(lane.key);
        if (!item)
            return tl::unexpected(item.error());
        const Item& last = **item;
        pictures[at].stale = !last.drawn || last.scene != lane.scene.get() ||
                             last.lod != lane.lod || last.camera != camera ||
                             last.options != options || last.size != lane.size;
        if (pictures[at].stale)
            queue.emplace_back(last.drawn_at, at);
    }
    std::sort(queue.begin(), queue.end());
    const auto begin = std::chrono::steady_clock::now();
    for (std::size_t done = 0; done < queue.size(); ++done) {
        const std::size_t at = queue[done].second;
        Item& item = items_.at(wanted[at].key);
        if (done > 0 && millisecondsSince(begin) + item.cost_ms > budget_ms)
            continue;
        if (const auto drawn = drawItem(item, wanted[at], camera, options); !drawn)
            return tl::unexpected(drawn.error());
        pictures[at].stale = false;
        pictures[at].drew = true;
    }
    for (Picture& picture : pictures)
        if (const auto item = items_.find(picture.key);
            item != items_.end() && item->second.drawn) {
            picture.texture = item->second.view.texture();
            picture.cost_ms = item->second.cost_ms;
        }
    return pictures;
}

std::optional<Picked> ViewSet::pick(std::uint32_t key, const glm::dvec2& point) const {
    const auto item = items_.find(key);
    if (item == items_.end() || !item->second.drawn)
        return std::nullopt;
    const Item& last = item->second;
    const auto scene = scenes_.find(last.scene);
    if (scene == scenes_.end())
        return std::nullopt;
    return lodestone::pick({&scene->second, &last.handle, last.camera, last.options, last.size},
                           point);
}

} // namespace lodestone
