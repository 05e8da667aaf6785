#include "app/main/picture_differences.h"

#include "simplify/measure/image_difference.h"

#include <algorithm>

namespace lodestone {

struct PictureDifferences::Task {
    std::uint32_t lane = 0;
    Source source;
    Picture picture;
    Picture reference;
    Pixels difference; // by the thread
    double flip = 0.0;
    std::string failure;
};

namespace {

Picture pictureOf(Pixels pixels) {
    return {pixels.width, pixels.height, std::move(pixels.rgba)};
}

} // namespace

void PictureDifferences::start(std::uint32_t lane,
                               const Source& source,
                               Pixels picture,
                               Pixels reference) {
    task_ = std::make_shared<Task>();
    task_->lane = lane;
    task_->source = source;
    task_->picture = pictureOf(std::move(picture));
    task_->reference = pictureOf(std::move(reference));
    work_.emplace([task = task_] {
        const Result<std::vector<float>> map =
            flipMap(task->reference, task->picture, {}, JobContext());
        if (!map) {
            task->failure = map.error().message;
            return;
        }
        Pixels& difference = task->difference;
        difference = Pixels(task->picture.width_px, task->picture.height_px, {0, 0, 0, 255});
        double sum = 0.0;
        for (std::size_t at = 0; at < map->size(); ++at) {
            sum += static_cast<double>((*map)[at]);
            const MapColor color = mapColorAt(task->source.colors, static_cast<double>((*map)[at]));
            std::copy(color.begin(),
                      color.end(),
                      difference.rgba.begin() + static_cast<std::ptrdiff_t>(4 * at));
        }
        task->flip = sum / static_cast<double>(std::max<std::size_t>(map->size(), 1));
    });
}

void PictureDifferences::collect(Session& session) {
    if (!work_ || !work_->finished())
        return;
    const std::string failure = work_->failure().empty() ? task_->failure : work_->failure();
    Entry& entry = entries_[task_->lane];
    entry.made_of = task_->source; // failed ones are not tried again
    if (failure.empty()) {
        const Pixels& difference = task_->difference;
        entry.texture.upload(
            difference.rgba,
            {static_cast<int>(difference.width), static_cast<int>(difference.height)});
        session.setFlip(task_->lane, task_->flip);
    } else {
        session.reportError(failure);
    }
    work_.reset();
    task_.reset();
}

void PictureDifferences::update(Session& session,
                                const ViewSet& views,
                                std::span<const ViewSet::Picture> pictures,
                                const ViewSet::Picture& reference,
                                ColorMap colors) {
    collect(session);
    const auto complete = [](const ViewSet::Picture& picture) {
        return picture.texture != 0 && !picture.stale && !picture.draft;
    };
    for (const ViewSet::Picture& picture : pictures) {
        if (picture.key == reference.key || !complete(picture) || !complete(reference))
            continue;
        Entry& entry = entries_[picture.key];
        entry.wanted = {picture.version, reference.version, colors};
        if (entry.wanted == entry.made_of || work_)
            continue;
        Result<Pixels> test = views.readPixels(picture.key);
        Result<Pixels> original = views.readPixels(reference.key);
        if (!test || !original) {
            session.reportError((test ? original : test).error().message);
            entry.made_of = entry.wanted;
            continue;
        }
        start(picture.key, entry.wanted, std::move(*test), std::move(*original));
    }
}

void PictureDifferences::clear(Session& session) {
    for (const auto& [lane, entry] : entries_)
        session.setFlip(lane, std::nullopt);
    entries_.clear();
}

PictureDifferences::Shown PictureDifferences::of(std::uint32_t lane) const {
    const auto entry = entries_.find(lane);
    if (entry == entries_.end())
        return {};
    return {entry->second.texture.texture(), entry->second.wanted == entry->second.made_of};
}

} // namespace lodestone
