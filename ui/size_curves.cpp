#include "ui/size_curves.h"

#include "scene/thread_priority.h"

#include <algorithm>
#include <cmath>

namespace lodestone::ui {

namespace {

constexpr std::size_t kPointCount = 40;
constexpr std::size_t kFewPoints = 9; // where each is computed anew
constexpr double kSmallestRatio = 0.001;

SizeCurve computeCurve(const LodSource& source,
                       const ExportOptions& options,
                       std::size_t point_count,
                       std::uint64_t original_triangles,
                       const std::stop_token& stop) {
    const ByteModel bytes(source.scene(), options);
    SizeCurve curve;
    for (std::size_t at = 0; at < point_count && !stop.stop_requested(); ++at) {
        // Denser towards few triangles, where curves bend.
        const double along = static_cast<double>(at) / static_cast<double>(point_count - 1);
        const Target target{Target::Kind::Ratio, std::max(kSmallestRatio, along * along)};
        const std::uint64_t position = source.resolve(target, bytes).position;
        const double ratio = static_cast<double>(source.trianglesAt(position)) /
                             static_cast<double>(std::max<std::uint64_t>(1, original_triangles));
        if (!curve.empty() && ratio <= curve.back().ratio)
            continue; // stuck at a floor
        curve.push_back({ratio,
                         static_cast<double>(bytes.bytes(source.shapeAt(position))),
                         source.errorAt(position)});
    }
    return curve;
}

} // namespace

bool SizeCurves::Key::matches(const Key& other) const {
    return lane == other.lane && source == other.source && options == other.options;
}

void SizeCurves::start(Key key, std::uint64_t original_triangles) {
    task_ = std::make_shared<Task>();
    task_->key = std::move(key);
    thread_ = std::jthread([task = task_, original_triangles](const std::stop_token& stop) {
        const BackgroundPriority priority;
        task->curve = computeCurve(
            *task->key.source, task->key.options, task->key.point_count, original_triangles, stop);
        task->done.store(true, std::memory_order_release);
    });
}

bool SizeCurves::collect() {
    if (!task_ || !task_->done.load(std::memory_order_acquire))
        return false;
    thread_.join();
    std::erase_if(known_, [&](const Known& known) { return known.key.lane == task_->key.lane; });
    known_.push_back({std::move(task_->key), std::move(task_->curve)});
    task_.reset();
    return true;
}

bool SizeCurves::update(const Document& document) {
    const bool changed = collect();
    const std::size_t gone = std::erase_if(
        known_, [&](const Known& known) { return !document.findLane(known.key.lane); });
    for (const Lane& lane : document.lanes) {
        if (!lane.status.source || busy())
            continue;
        const bool one_shot =
            lane.settings.algorithm && lane.settings.algorithm->family == Family::OneShot;
        Key key{lane.id,
                lane.status.source,
                document.export_options,
                one_shot ? kFewPoints : kPointCount};
        const auto same = [&](const Known& known) { return known.key.matches(key); };
        if (std::none_of(known_.begin(), known_.end(), same))
            start(std::move(key), document.counts.triangles);
    }
    return changed || gone > 0;
}

const SizeCurve& SizeCurves::of(LaneId lane) const {
    static const SizeCurve kEmpty;
    for (const Known& known : known_)
        if (known.key.lane == lane)
            return known.curve;
    return kEmpty;
}

} // namespace lodestone::ui
