#include "simplify/pointcloud/cloud_cache.h"

#include <algorithm>

namespace lodestone {

namespace {

template <class Entries>
typename Entries::value_type findPosition(const Entries& entries, std::uint64_t position) {
    const auto found = std::ranges::find_if(
        entries, [&](const auto& entry) { return entry->position == position; });
    return found == entries.end() ? nullptr : *found;
}

} // namespace

CloudCountsPtr CloudCache::counts(std::uint64_t position) const {
    const std::scoped_lock lock(mutex_);
    const auto found = counts_.find(position);
    return found == counts_.end() ? nullptr : found->second;
}

CloudDraftsPtr CloudCache::drafts(std::uint64_t position) const {
    const std::scoped_lock lock(mutex_);
    return findPosition(drafts_, position);
}

LodPtr CloudCache::lod(std::uint64_t position) const {
    const std::scoped_lock lock(mutex_);
    return findPosition(lods_, position);
}

void CloudCache::insert(const CloudDraftsPtr& drafts, const CloudCountsPtr& counts) {
    const std::scoped_lock lock(mutex_);
    counts_[drafts->position] = counts;
    drafts_.push_back(drafts);
    if (drafts_.size() > kMostDrafts)
        drafts_.pop_front();
}

void CloudCache::insert(const LodPtr& lod) {
    const std::scoped_lock lock(mutex_);
    lod_triangles_ += lod->unique_triangles;
    lods_.push_back(lod);
    while (lods_.size() > kMostLods || (lods_.size() > 2 && lod_triangles_ > kMostTriangles)) {
        lod_triangles_ -= lods_.front()->unique_triangles;
        lods_.pop_front();
    }
}

std::optional<CloudDraft> CloudCache::coarsest(std::size_t submesh, CloudFloor floor) const {
    const std::scoped_lock lock(mutex_);
    const auto found = coarsest_.find({submesh, floor});
    return found == coarsest_.end() ? std::nullopt : std::optional(found->second);
}

void CloudCache::insertCoarsest(std::size_t submesh, CloudFloor floor, const CloudDraft& draft) {
    const std::scoped_lock lock(mutex_);
    coarsest_.try_emplace({submesh, floor}, draft);
}

} // namespace lodestone
