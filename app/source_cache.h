#pragma once
// Built sources and byte models, shared by lanes that would build the same. Main thread only.
#include "app/lane.h"

namespace lodestone {

// What a source is built from. Parameters complete, defaults filled in, but for those that speak of
// textures, which are made from LODs.
struct BuildKey {
    ScenePtr scene;
    const Algorithm* algorithm = nullptr;
    ParameterValues parameters;

    friend bool operator==(const BuildKey&, const BuildKey&) = default;
};

BuildKey buildKey(const ScenePtr& scene, const LaneSettings& settings);
bool sameOptions(const ExportOptions& a, const ExportOptions& b);
bool sameSchedule(const ScheduleOptions& a, const ScheduleOptions& b);

struct CachedSource {
    BuildKey key;
    ScheduleOptions schedule; // it was prepared with
    LodSourcePtr source;
};

class SourceCache {
public:
    const CachedSource* find(const BuildKey& key) const; // nullptr if absent
    // The newest of the key's scene and family, for prepareLike; null if there is none.
    LodSourcePtr findLike(const BuildKey& key) const;
    void insert(CachedSource entry);
    // Keeps what `used` names and the newest few others, so that undo finds them again; nothing of
    // another scene.
    void trim(const ScenePtr& scene, std::span<const BuildKey> used);

private:
    std::vector<CachedSource> entries_; // oldest first
};

using ByteModelPtr = std::shared_ptr<const ByteModel>;

class ByteModelCache {
public:
    ByteModelPtr find(const ScenePtr& scene, const ExportOptions& options) const; // null if absent
    void insert(const ScenePtr& scene, const ExportOptions& options, ByteModelPtr model);
    // Forgets models of scenes that are not among `scenes`.
    void trim(std::span<const ScenePtr> scenes);

private:
    struct Entry {
        ScenePtr scene;
        ExportOptions options;
        ByteModelPtr model;
    };

    std::vector<Entry> entries_;
};

} // namespace lodestone
