#include "render/view_set.h"

#include <algorithm>
#include <chrono>

namespace lodestone {

namespace {

// How a wanted picture is drawn.
ViewOptions optionsOf(const ViewSet::Wanted& wanted, const ViewOptions& options) {
    ViewOptions result = options;
    if (wanted.draft)
        result.samples = 1;
    result.highlighted = wanted.highlighted;
    return result;
}

// A stale picture. Cheap ones come first, then those that have waited longest.
struct Waiting {
    bool exceeds_budget = false;
    std::uint64_t drawn_at = 0; // turn of the last draw
    std::size_t place = 0;      // in the wanted ones

    auto operator<=>(const Waiting&) const = default; // NOLINT(modernize-use-nullptr): false alarm
};

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

View::Input ViewSet::inputOf(const Item& item) const {
    View::Input input{
        &scenes_.at(item.scene), &item.shown().handle, item.camera, item.options, item.size};
    if (item.has_marks && marks_.lod) {
        input.marked_scene = &scenes_.at(marks_.scene);
        input.marked_lod = &marks_.handle;
    }
    return input;
}

// A call may still pack that much itself.
bool ViewSet::takesNoLonger(std::uint64_t work) {
    if (last_work_.packed + work > kMostPackedPerCall)
        return false;
    last_work_.packed += work;
    return true;
}

Result<bool> ViewSet::isSceneReady(const ScenePtr& scene) {
    if (scenes_.contains(scene.get()))
        return true;
    if (!takesNoLonger(preparationWork(*scene))) {
        if (!delivery_.underWay())
            delivery_.startScene(renderer_, scene);
        return false;
    }
    Result<GpuScene> created = GpuScene::create(renderer_, scene);
    if (!created)
        return tl::unexpected(created.error());
    scenes_.emplace(scene.get(), std::move(*created));
    return true;
}

Result<bool> ViewSet::areMarksReady(const Wanted& wanted) {
    if (!wanted.marked_lod || (marks_.lod == wanted.marked_lod && marks_.handle.valid()))
        return true;
    if (Result<bool> scene = isSceneReady(wanted.marked_scene); !scene || !*scene)
        return scene;
    GpuScene& scene = scenes_.at(wanted.marked_scene.get());
    Result<LodPackage> package = scene.package(*wanted.marked_lod);
    if (!package)
        return tl::unexpected(package.error());
    if (!takesNoLonger(package->work())) {
        if (!delivery_.underWay())
            delivery_.startLod(wanted.marked_scene, wanted.marked_lod, std::move(*package));
        return false;
    }
    marks_ = {};
    if (const auto updated = scene.update(marks_.handle, *wanted.marked_lod); !updated)
        return tl::unexpected(updated.error());
    marks_.lod = wanted.marked_lod;
    marks_.scene = wanted.marked_scene.get();
    return true;
}

Result<bool> ViewSet::isReady(const Item& item, const Wanted& wanted) {
    if (Result<bool> marks = areMarksReady(wanted); !marks || !*marks)
        return marks;
    if (Result<bool> scene = isSceneReady(wanted.scene); !scene || !*scene)
        return scene;
    const std::shared_ptr<const Lod>& lod = wanted.draft ? wanted.draft : wanted.lod;
    const Item::Uploaded& last = wanted.draft ? item.draft : item.full;
    if (item.scene == wanted.scene.get() && last.handle.valid() && last.lod == lod)
        return true;
    Result<LodPackage> package = scenes_.at(wanted.scene.get()).package(*lod);
    if (!package)
        return tl::unexpected(package.error());
    if (takesNoLonger(package->work()))
        return true;
    if (!delivery_.underWay())
        delivery_.startLod(wanted.scene, lod, std::move(*package));
    return false;
}

// What nobody wants any more is given up; what arrived at the last call has been taken since.
Result<void> ViewSet::advanceDelivery(std::span<const Wanted> wanted) {
    last_work_ = {};
    if (delivery_.arrivedLod())
        delivery_.finish();
    if (!delivery_.underWay())
        return {};
    const DeliveryKey& key = *delivery_.key();
    const bool is_wanted = std::ranges::any_of(wanted, [&](const Wanted& lane) {
        return (lane.scene == key.scene &&
                (!key.lod || key.lod == lane.lod || key.lod == lane.draft)) ||
               (lane.marked_scene == key.scene && (!key.lod || key.lod == lane.marked_lod));
    });
    if (!is_wanted) {
        delivery_.giveUp();
        return {};
    }
    const std::uint64_t copied_before = delivery_.copiedBytes();
    const Scene* const scene = key.scene.get();
    Result<std::optional<GpuScene>> complete = delivery_.step(renderer_);
    last_work_.copied_bytes = delivery_.copiedBytes() - copied_before;
    if (!complete)
        return tl::unexpected(complete.error());
    if (const LodPackage* const arrived = delivery_.arrivedLod())
        scenes_.at(scene).offer(*arrived);
    if (*complete)
        scenes_.insert_or_assign(scene, std::move(**complete));
    return {};
}

double ViewSet::costOf(const Item& item, const Wanted& wanted) {
    return wanted.draft ? item.draft.cost_ms : item.full.cost_ms;
}

void ViewSet::forgetUnwanted(std::span<const Wanted> wanted) {
    std::erase_if(items_, [&](const auto& entry) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const Wanted& lane) {
            return lane.key == entry.first;
        });
    });
    std::erase_if(scenes_, [&](const auto& entry) {
        return std::none_of(wanted.begin(), wanted.end(), [&](const Wanted& lane) {
            return lane.scene.get() == entry.first || lane.marked_scene.get() == entry.first ||
                   lane.kept_scene.get() == entry.first;
        });
    });
    for (auto& [key, item] : items_)
        if (!scenes_.contains(item.scene)) {
            item.scene = nullptr; // another may come to lie where it lay
            item.complete = false;
        }
    if (marks_.lod && std::ranges::find(wanted, marks_.lod, &Wanted::marked_lod) == wanted.end())
        marks_ = {};
}

bool ViewSet::isStale(const Item& item,
                      const Wanted& wanted,
                      const OrbitCamera& camera,
                      const ViewOptions& options) {
    const bool draft = wanted.draft != nullptr;
    return !item.complete || item.has_marks != (wanted.marked_lod != nullptr) ||
           item.shows_draft != draft || item.scene != wanted.scene.get() ||
           item.shown().lod != (draft ? wanted.draft : wanted.lod) || item.camera != camera ||
           item.options != optionsOf(wanted, options) || item.size != wanted.size;
}

// Nothing but the camera has changed since its first slice was drawn. It is finished as it was
// begun, so that a picture of many slices is seen at all while the camera moves on.
bool ViewSet::isUnderWay(const Item& item, const Wanted& wanted, const ViewOptions& options) {
    return !item.complete && !item.shows_draft && !wanted.draft && item.full.lod == wanted.lod &&
           item.scene == wanted.scene.get() && item.size == wanted.size &&
           item.has_marks == (wanted.marked_lod != nullptr) &&
           item.options == optionsOf(wanted, options);
}

Result<bool> ViewSet::drawItem(Item& item,
                               const Wanted& wanted,
                               const OrbitCamera& camera,
                               const ViewOptions& options,
                               double budget_ms) {
    GpuScene& scene = scenes_.at(wanted.scene.get());
    if (item.scene != wanted.scene.get()) {
        item.full = Item::Uploaded();
        item.draft = Item::Uploaded();
    }
    if (!isUnderWay(item, wanted, options))
        item.camera = camera;
    item.scene = wanted.scene.get();
    scene.setMoment(options.moment);
    Item::Uploaded& shown = wanted.draft ? item.draft : item.full;
    const std::shared_ptr<const Lod>& lod = wanted.draft ? wanted.draft : wanted.lod;
    if (!shown.handle.valid() || shown.lod != lod) {
        if (const auto updated = scene.update(shown.handle, *lod); !updated)
            return tl::unexpected(updated.error());
        shown.lod = lod;
    }
    item.shows_draft = wanted.draft != nullptr;
    item.options = optionsOf(wanted, options);
    item.has_marks = wanted.marked_lod != nullptr;
    View::Input input = inputOf(item);
    input.size = wanted.size; // the item's is that of a complete picture
    // Drafts are sized to be quick; in slices they would never be seen while the camera moves.
    if (wanted.draft)
        budget_ms = View::kNoBudget;
    const Result<DrawReport> report = item.view.draw(input, budget_ms);
    if (!report)
        return tl::unexpected(report.error());
    item.size = wanted.size;
    item.complete = report->complete;
    if (!item.complete)
        return false;
    if (report->cost_known)
        shown.cost_ms = report->cost_ms;
    item.drawn_at = ++turn_;
    item.drawn = true;
    return true;
}

Result<std::vector<ViewSet::Picture>> ViewSet::draw(std::span<const Wanted> wanted,
                                                    const OrbitCamera& camera,
                                                    const ViewOptions& options,
                                                    double budget_ms) {
    const auto begin = std::chrono::steady_clock::now();
    forgetUnwanted(wanted);
    if (const Result<void> advanced = advanceDelivery(wanted); !advanced)
        return tl::unexpected(advanced.error());
    std::vector<Picture> pictures(wanted.size());
    std::vector<Waiting> queue;
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
        pictures[at].stale = isStale(last, lane, camera, options);
        if (!pictures[at].stale)
            continue;
        const Result<bool> ready = isReady(last, lane);
        if (!ready)
            return tl::unexpected(ready.error());
        pictures[at].on_its_way = !*ready;
        if (*ready)
            queue.push_back({costOf(last, lane) > budget_ms, last.drawn_at, at});
    }
    std::sort(queue.begin(), queue.end());
    for (std::size_t done = 0; done < queue.size(); ++done) {
        const std::size_t at = queue[done].place;
        Item& item = items_.at(wanted[at].key);
        const double left_ms = budget_ms - millisecondsSince(begin);
        if (done > 0 && std::min(costOf(item, wanted[at]), budget_ms * 0.5) > left_ms)
            continue;
        const Result<bool> drawn = drawItem(item, wanted[at], camera, options, left_ms);
        if (!drawn)
            return tl::unexpected(drawn.error());
        pictures[at].stale = !*drawn || isStale(item, wanted[at], camera, options);
        pictures[at].drew = *drawn;
    }
    for (Picture& picture : pictures)
        if (const auto item = items_.find(picture.key);
            item != items_.end() && item->second.drawn) {
            picture.texture = item->second.view.texture();
            picture.draft = item->second.shows_draft;
            picture.version = item->second.drawn_at;
            picture.cost_ms = item->second.full.cost_ms;
            picture.draft_cost_ms = item->second.draft.cost_ms;
        }
    return pictures;
}

Result<MeasureReport> ViewSet::measure(std::uint32_t key, const MeasureOptions& options) {
    const auto found = items_.find(key);
    if (found == items_.end() || !found->second.complete)
        return fail(ErrorKind::Usage, "this lane has no picture yet; wait for it");
    return found->second.view.measure(inputOf(found->second), options);
}

Result<Pixels> ViewSet::readPixels(std::uint32_t key) const {
    const auto found = items_.find(key);
    if (found == items_.end() || !found->second.complete)
        return fail(ErrorKind::Usage, "this lane has no picture yet; wait for it");
    return found->second.view.readPixels();
}

const Scene* ViewSet::pickedScene(std::uint32_t key) const {
    const auto item = items_.find(key);
    return item == items_.end() || !item->second.drawn ? nullptr : item->second.scene;
}

std::optional<Picked> ViewSet::pick(std::uint32_t key, const glm::dvec2& point) const {
    if (pickedScene(key) == nullptr)
        return std::nullopt;
    return lodestone::pick(inputOf(items_.at(key)), point);
}

std::vector<Highlight> ViewSet::pickBox(std::uint32_t key, const PickBox& box) const {
    if (pickedScene(key) == nullptr)
        return {};
    return lodestone::pickBox(inputOf(items_.at(key)), box);
}

} // namespace lodestone
