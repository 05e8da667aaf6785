#pragma once
// Brings lanes up to date: build, schedule, resolve, read out. Main thread only.
#include "app/jobs.h"
#include "app/lane_slide.h"
#include "app/source_cache.h"

#include <map>

namespace lodestone {

class LaneWorker {
public:
    explicit LaneWorker(JobQueue& jobs) : jobs_(jobs) {}

    // Every lane once: commits nothing, starts the builds that are missing, reads out what changed.
    // Returns true if some lane's status changed.
    bool refresh(Document& document);
    // A finished Prepare or Predict job. A lane's is dropped if it is gone or its revision moved
    // on.
    void commit(Document& document, FinishedJob& finished);
    // The user cancelled a lane's build: it and the lanes waiting for the same build stay Failed
    // until retry() or another setting.
    void markCancelled(Document& document, LaneId lane);
    void retry(LaneId lane);

    // Predicts sizes of a scene's LODs with some options; null while a job makes it or after that
    // has failed.
    ByteModelPtr byteModel(const ScenePtr& scene, const ExportOptions& options);
    void forgetPrediction(JobId job); // cancelled: asked for again, it starts anew

private:
    struct Failure {
        std::uint64_t revision = 0;
        std::string message;
    };

    struct Prediction {
        ScenePtr scene;
        ExportOptions options;
        JobId job = 0; // of a job that is gone: failed or cancelled
    };

    struct Scheduled {
        LodSourcePtr base;
        ScheduleOptions options;
        ByteModelPtr bytes; // null unless the ordering depends on it
        LodSourcePtr source;
    };

    struct Shown {
        LodSourcePtr source;
        std::optional<Target> target;
        std::optional<std::uint64_t> position;
        ByteModelPtr bytes;

        bool matches(const Shown& other) const;
    };

    struct Work {
        BuildKey key;
        ScheduleOptions pending_schedule; // of the job that runs
        JobId job = 0;                    // 0: none
        LodSourcePtr scheduling_base;     // null: the job builds; else it only reschedules this
        ByteModelPtr scheduling_bytes;
        bool shows_key = false; // a LOD of `key` was shown
        std::optional<Failure> failure;
        Scheduled scheduled;
        Shown shown;                  // what `status.lod` was made from
        std::optional<Shown> reading; // what the job that runs reads out
        LaneSlide slide;
        bool slid = false; // the LOD shown is none of the source's, but between two
    };

    // Where a LOD lies in its source's sequence: at one of its positions, or between two.
    enum class LodPlace : std::uint8_t { AtPosition, Between };

    void commitPrediction(Document& document, FinishedJob& finished);
    void trimCaches(const Document& document);
    void forgetGoneLanes(const Document& document);
    bool refreshLane(Document& document, Lane& lane);
    bool refreshBuilding(Lane& lane, JobId job) const;
    bool showOriginal(const Document& document, Lane& lane, Work& work);
    void startBuild(const Document& document, const Lane& lane, Work& work);
    // The source with the lane's schedule; null while a job makes it.
    LodSourcePtr scheduledSource(const Document& document,
                                 const Lane& lane,
                                 Work& work,
                                 const CachedSource& cached,
                                 const ByteModelPtr& bytes);
    void startScheduling(const Lane& lane,
                         Work& work,
                         const LodSourcePtr& base,
                         const ScheduleOptions& options,
                         const ByteModelPtr& bytes);
    bool show(const Document& document, Lane& lane, Work& work, Shown wanted);
    // The same for a lane that slides; false if its source cannot, or it is shown already.
    bool slide(const Document& document, Lane& lane, Work& work, const Shown& wanted);
    // The same for sources that take longer than a frame: a job reads out, and the newest wish
    // follows once it is back, so that a drag sees what there is.
    bool showOneShot(Lane& lane, Work& work, Shown wanted);
    // Any thread. previous: shown of this source, or nullptr. To be dropped where asked to stop.
    static ReadOut readOut(const Shown& wanted, const Lod* previous, const JobContext& job);
    void commitReadOut(
        const Document& document, Lane& lane, Work& work, ReadOut read_out, LodPlace place);
    const Work* buildingElsewhere(LaneId lane, const BuildKey& key) const;

    JobQueue& jobs_;
    SourceCache sources_;
    ByteModelCache byte_models_;
    std::vector<Prediction> predictions_; // not in byte_models_ yet
    std::map<LaneId, Work> work_;
    std::shared_ptr<const Lod> full_lod_; // of full_lod_scene_
    ScenePtr full_lod_scene_;
};

} // namespace lodestone
