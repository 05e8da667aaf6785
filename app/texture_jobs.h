#pragma once
// The jobs that transfer textures to the LODs of lanes that ask for it. Main thread only.
#include "app/lane_worker.h"

#include <map>

namespace lodestone {

// What a lane's parameters and algorithm ask for; nullopt: it keeps its textures.
std::optional<BakeOptions> wantedTextures(const LaneSettings& settings);

// Whether a lane's textures are of the LOD shown and made as wanted.
bool hasTextures(const LaneStatus& status, const BakeOptions& wanted);

class TextureJobs {
public:
    // lanes: predicts sizes.
    TextureJobs(JobQueue& jobs, LaneWorker& lanes) : jobs_(jobs), lanes_(lanes) {}

    // Every lane once: starts the transfers that are missing, the newest in place of an older one,
    // but none while a target is dragged. Returns whether some lane's status changed.
    bool refresh(Document& document);
    // A finished Texture job. Dropped if its lane is gone or wants another by now.
    void commit(Document& document, FinishedJob& finished);
    // The user cancelled one: not tried again until the lane shows another LOD or retry().
    void cancelled(Document& document, LaneId lane);
    void retry(LaneId lane);

private:
    // What a transfer is made for.
    struct Key {
        std::uint64_t lod_revision = 0;
        BakeOptions options;

        bool operator==(const Key&) const = default;
    };

    struct Sized {
        std::optional<Key> key; // nullopt: kept textures
        std::uint64_t kept_bytes = 0;
        LaneTexturesPtr textures; // null: estimated
        ByteModelPtr model;       // of their scene

        bool operator==(const Sized&) const = default;
    };

    struct Work {
        JobId job = 0; // 0: none
        Key key;       // of the job, or of the last one that failed
        bool failed = false;
        Sized sized; // what the lane's size was worked out for
        std::uint64_t bytes = 0;
    };

    bool refreshLane(const Document& document, Lane& lane);
    bool refreshSize(const Document& document,
                     const std::optional<BakeOptions>& wanted,
                     Lane& lane,
                     Work& work);
    void start(const Lane& lane, Work& work, const Key& key);
    void stop(LaneId lane, Work& work);

    JobQueue& jobs_;
    LaneWorker& lanes_;
    std::map<LaneId, Work> work_;
};

} // namespace lodestone
