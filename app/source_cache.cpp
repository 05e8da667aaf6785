#include "app/source_cache.h"

#include <algorithm>

namespace lodestone {

namespace {

constexpr std::size_t kUnusedSourcesKept = 2;

} // namespace

BuildKey buildKey(const ScenePtr& scene, const LaneSettings& settings) {
    BuildKey key{scene, settings.algorithm, {}};
    if (settings.algorithm)
        for (const ParameterInfo& info : settings.algorithm->parameters)
            if (!info.of_textures)
                key.parameters[std::string(info.id)] =
                    parameterValue(*settings.algorithm, settings.parameters, info.id);
    return key;
}

bool sameOptions(const ExportOptions& a, const ExportOptions& b) {
    return a == b;
}

bool sameSchedule(const ScheduleOptions& a, const ScheduleOptions& b) {
    return a.ordering == b.ordering && a.importance == b.importance && a.locked == b.locked;
}

const CachedSource* SourceCache::find(const BuildKey& key) const {
    const auto found = std::ranges::find(entries_, key, &CachedSource::key);
    return found == entries_.end() ? nullptr : &*found;
}

LodSourcePtr SourceCache::findLike(const BuildKey& key) const {
    for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry)
        if (entry->key.scene == key.scene && entry->key.algorithm->family == key.algorithm->family)
            return entry->source;
    return nullptr;
}

void SourceCache::insert(CachedSource entry) {
    std::erase_if(entries_, [&](const CachedSource& old) { return old.key == entry.key; });
    entries_.push_back(std::move(entry));
}

void SourceCache::trim(const ScenePtr& scene, std::span<const BuildKey> used) {
    const auto is_used = [&](const CachedSource& entry) {
        return std::ranges::find(used, entry.key) != used.end();
    };
    std::erase_if(entries_, [&](const CachedSource& entry) { return entry.key.scene != scene; });
    auto unused = static_cast<std::size_t>(
        std::ranges::count_if(entries_, [&](const auto& entry) { return !is_used(entry); }));
    std::erase_if(entries_, [&](const CachedSource& entry) {
        if (unused <= kUnusedSourcesKept || is_used(entry))
            return false;
        --unused;
        return true;
    });
}

ByteModelPtr ByteModelCache::find(const ScenePtr& scene, const ExportOptions& options) const {
    const auto found = std::ranges::find_if(entries_, [&](const Entry& entry) {
        return entry.scene == scene && sameOptions(entry.options, options);
    });
    return found == entries_.end() ? nullptr : found->model;
}

void ByteModelCache::insert(const ScenePtr& scene,
                            const ExportOptions& options,
                            ByteModelPtr model) {
    if (!find(scene, options))
        entries_.push_back({scene, options, std::move(model)});
}

void ByteModelCache::trim(std::span<const ScenePtr> scenes) {
    std::erase_if(entries_, [&](const Entry& entry) {
        return std::ranges::find(scenes, entry.scene) == scenes.end();
    });
}

} // namespace lodestone
