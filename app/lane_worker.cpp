#include "app/lane_worker.h"

#include <algorithm>
#include <chrono>
#include <fmt/core.h>

namespace lodestone {

namespace {

// A schedule that took longer than this is made in a job, so that no frame waits for it.
constexpr double kSynchronousScheduleSeconds = 0.02;

bool sameTarget(const Target& a, const Target& b) {
    return a.kind == b.kind && a.value == b.value;
}

// Updates a value and says whether it was another.
template <class T, class U>
bool assign(T& value, U&& next) {
    if (value == next)
        return false;
    value = std::forward<U>(next);
    return true;
}

bool setState(Lane& lane, LaneState state, double progress = 0.0, std::string failure = {}) {
    bool changed = assign(lane.status.state, state);
    changed |= assign(lane.status.progress, progress);
    changed |= assign(lane.status.failure, std::move(failure));
    return changed;
}

// like: a source of the same scene and family, or null.
Result<JobResult> prepareSource(const BuildKey& key,
                                const LodSourcePtr& like,
                                const ScheduleOptions& schedule,
                                const ExportOptions& export_options,
                                const JobContext& context) {
    const Algorithm& algorithm = *key.algorithm;
    Result<LodSourcePtr> source =
        like && algorithm.prepareLike
            ? algorithm.prepareLike(*like, key.parameters, schedule, context)
            : algorithm.prepare(key.scene, key.parameters, schedule, context);
    if (!source)
        return tl::unexpected<Error>(std::move(source.error()));
    PreparedSource prepared;
    prepared.bytes = std::make_shared<const ByteModel>((*source)->scene(), export_options);
    prepared.source = std::move(*source);
    return JobResult(std::move(prepared));
}

void setShown(const Document& document, Lane& lane, std::shared_ptr<const Lod> lod) {
    LaneStatus& status = lane.status;
    status.lod = std::move(lod);
    ++status.lod_revision;
    status.distance.reset();
    status.rate.reset();
    status.numbers.triangles = status.lod->triangles;
    status.numbers.unique_triangles = status.lod->unique_triangles;
    status.numbers.instances = status.lod->instances;
    const auto all = static_cast<double>(std::max<std::uint64_t>(document.counts.triangles, 1));
    status.numbers.ratio = static_cast<double>(status.lod->triangles) / all;
}

} // namespace

bool LaneWorker::refresh(Document& document) {
    forgetGoneLanes(document);
    if (!document.scene)
        return false;
    bool changed = false;
    for (Lane& lane : document.lanes)
        changed |= refreshLane(document, lane);

    trimCaches(document);
    return changed;
}

void LaneWorker::trimCaches(const Document& document) {
    std::vector<BuildKey> used;
    std::vector<ScenePtr> scenes{document.scene};
    for (const Lane& lane : document.lanes) {
        used.push_back(work_[lane.id].key);
        if (lane.status.scene)
            scenes.push_back(lane.status.scene);
        if (lane.status.textures)
            scenes.push_back(lane.status.textures->baked.scene);
    }
    sources_.trim(document.scene, used);
    byte_models_.trim(scenes);
    std::erase_if(predictions_, [&](const Prediction& prediction) {
        return std::ranges::find(scenes, prediction.scene) == scenes.end();
    });
}

void LaneWorker::forgetGoneLanes(const Document& document) {
    std::erase_if(work_, [&](const auto& item) {
        if (document.findLane(item.first))
            return false;
        jobs_.cancel(item.first, JobKind::Prepare);
        jobs_.cancel(item.first, JobKind::Measure);
        jobs_.cancel(item.first, JobKind::ErrorMap);
        return true;
    });
}

bool LaneWorker::refreshLane(Document& document, Lane& lane) {
    Work& work = work_[lane.id];
    BuildKey key = buildKey(document.scene, lane.settings);
    // While a parameter is dragged, what is under way is finished and shown: starting anew with
    // every move of the mouse would never come to an end.
    if (!(key == work.key) && document.history.dragging() && lane.status.lod && !work.shows_key &&
        (work.job != 0 || sources_.find(work.key)))
        key = work.key;
    if (work.job != 0 && !(key == work.key)) {
        jobs_.cancel(lane.id, JobKind::Prepare);
        work.job = 0;
        work.reading.reset();
    }
    if (!(key == work.key))
        work.shows_key = false;
    work.key = std::move(key);
    if (!lane.settings.algorithm)
        return showOriginal(document, lane, work);

    const CachedSource* cached = sources_.find(work.key);
    if (!cached) {
        if (work.failure && work.failure->revision == lane.revision)
            return setState(lane, LaneState::Failed, 0.0, work.failure->message);
        work.failure.reset();
        const Work* builder = work.job != 0 ? &work : buildingElsewhere(lane.id, work.key);
        if (!builder) {
            startBuild(document, lane, work);
            builder = &work;
        }
        return refreshBuilding(lane, builder->job);
    }
    const ByteModelPtr bytes = byteModel(cached->source->scene(), document.export_options);
    if (!bytes)
        return setState(lane, LaneState::Building, 1.0);
    const LodSourcePtr source = scheduledSource(document, lane, work, *cached, bytes);
    if (!source)
        return refreshBuilding(lane, work.job);
    Shown wanted{source, lane.settings.target, lane.settings.position, bytes};
    if (work.failure && work.failure->revision == lane.revision)
        return setState(lane, LaneState::Failed, 0.0, work.failure->message);
    if (lane.settings.algorithm->family == Family::OneShot)
        return showOneShot(lane, work, std::move(wanted));
    const bool shown =
        slide(document, lane, work, wanted) || show(document, lane, work, std::move(wanted));
    return setState(lane, LaneState::Ready, 1.0) || shown;
}

bool LaneWorker::refreshBuilding(Lane& lane, JobId job) const {
    const std::vector<JobStatus> jobs = jobs_.status();
    const auto found = std::ranges::find(jobs, job, &JobStatus::id);
    if (found == jobs.end() || !found->running)
        return setState(lane, LaneState::Queued);
    return setState(lane, LaneState::Building, found->progress);
}

const LaneWorker::Work* LaneWorker::buildingElsewhere(LaneId lane, const BuildKey& key) const {
    for (const auto& [id, work] : work_)
        if (id != lane && work.job != 0 && !work.scheduling_base && !work.reading &&
            work.key == key)
            return &work;
    return nullptr;
}

bool LaneWorker::showOriginal(const Document& document, Lane& lane, Work& work) {
    if (full_lod_scene_ != document.scene) {
        full_lod_scene_ = document.scene;
        full_lod_ = std::make_shared<const Lod>(fullLod(*document.scene));
    }
    bool changed = setState(lane, LaneState::Ready, 1.0);
    LaneStatus& status = lane.status;
    if (status.lod != full_lod_) {
        jobs_.cancel(lane.id, JobKind::Measure);
        status.measuring = false;
        status.source.reset();
        status.error_map = {};
        jobs_.cancel(lane.id, JobKind::ErrorMap);
        status.scene = document.scene;
        setShown(document, lane, full_lod_);
        status.numbers.error_estimate = 0.0;
        status.numbers.note.clear();
        status.build_seconds = 0.0;
        work.shown = {};
        changed = true;
    }
    const ByteModelPtr bytes = byteModel(document.scene, document.export_options);
    if (changed || work.shown.bytes != bytes) {
        work.shown.bytes = bytes;
        status.numbers.kept_bytes = bytes ? bytes->bytes(shapeOf(*document.scene, *full_lod_)) : 0;
        status.numbers.predicted_bytes = status.numbers.kept_bytes;
        changed = true;
    }
    return changed;
}

void LaneWorker::startBuild(const Document& document, const Lane& lane, Work& work) {
    work.scheduling_base.reset();
    work.pending_schedule = scheduleOptions(document, lane.settings);
    JobSpec spec;
    spec.kind = JobKind::Prepare;
    spec.lane = lane.id;
    spec.revision = lane.revision;
    spec.label = fmt::format("Building {}", laneName(lane.settings));
    spec.run = [key = work.key,
                like = sources_.findLike(work.key),
                schedule = work.pending_schedule,
                export_options = document.export_options](const JobContext& context) {
        return prepareSource(key, like, schedule, export_options, context);
    };
    work.job = jobs_.start(std::move(spec));
}

LodSourcePtr LaneWorker::scheduledSource(const Document& document,
                                         const Lane& lane,
                                         Work& work,
                                         const CachedSource& cached,
                                         const ByteModelPtr& bytes) {
    const ScheduleOptions options = scheduleOptions(document, lane.settings);
    if (sameSchedule(options, cached.schedule))
        return cached.source;
    const ByteModelPtr deciding = options.ordering == Ordering::Byte ? bytes : nullptr;
    Scheduled& scheduled = work.scheduled;
    if (scheduled.source && scheduled.base == cached.source && scheduled.bytes == deciding &&
        sameSchedule(options, scheduled.options))
        return scheduled.source;
    if (cached.source->seconds_schedule <= kSynchronousScheduleSeconds) {
        scheduled = {cached.source, options, deciding, cached.source->rescheduled(options, *bytes)};
        return scheduled.source;
    }
    // A running one is left to finish: a drag that restarted it every frame would never see any.
    if (work.job == 0)
        startScheduling(lane, work, cached.source, options, bytes);
    return nullptr;
}

void LaneWorker::startScheduling(const Lane& lane,
                                 Work& work,
                                 const LodSourcePtr& base,
                                 const ScheduleOptions& options,
                                 const ByteModelPtr& bytes) {
    work.scheduling_base = base;
    work.scheduling_bytes = options.ordering == Ordering::Byte ? bytes : nullptr;
    work.pending_schedule = options;
    JobSpec spec;
    spec.kind = JobKind::Prepare;
    spec.lane = lane.id;
    spec.revision = lane.revision;
    spec.label = fmt::format("Scheduling {}", laneName(lane.settings));
    spec.run = [base, options, bytes](const JobContext&) -> Result<JobResult> {
        return JobResult(PreparedSource{base->rescheduled(options, *bytes), bytes});
    };
    work.job = jobs_.start(std::move(spec));
}

void LaneWorker::commit(Document& document, FinishedJob& finished) {
    if (finished.kind == JobKind::Predict)
        return commitPrediction(document, finished);
    Lane* lane = document.findLane(finished.lane);
    const auto found = work_.find(finished.lane);
    if (!lane || found == work_.end() || found->second.job != finished.id)
        return;
    Work& work = found->second;
    work.job = 0;
    if (lane->revision != finished.revision && !document.history.dragging()) {
        work.reading.reset();
        return;
    }
    if (!finished.result) {
        work.reading.reset();
        work.failure = Failure{finished.revision, finished.result.error().message};
        report(document,
               Severity::Error,
               fmt::format("{}: {}", finished.label, work.failure->message));
        return;
    }
    if (auto* const read_out = std::get_if<ReadOut>(&*finished.result)) {
        commitReadOut(document, *lane, work, std::move(*read_out), LodPlace::AtPosition);
        return;
    }
    auto& prepared = std::get<PreparedSource>(*finished.result);
    if (work.scheduling_base) {
        work.scheduled = {work.scheduling_base,
                          work.pending_schedule,
                          work.scheduling_bytes,
                          std::move(prepared.source)};
        work.scheduling_base.reset();
        return;
    }
    for (const std::string& note : prepared.source->notes())
        report(document, Severity::Info, fmt::format("{}: {}", laneName(lane->settings), note));
    byte_models_.insert(
        prepared.source->scene(), document.export_options, std::move(prepared.bytes));
    sources_.insert({work.key, work.pending_schedule, std::move(prepared.source)});
}

ByteModelPtr LaneWorker::byteModel(const ScenePtr& scene, const ExportOptions& options) {
    if (ByteModelPtr known = byte_models_.find(scene, options))
        return known;
    const bool started = std::ranges::any_of(predictions_, [&](const Prediction& prediction) {
        return prediction.scene == scene && sameOptions(prediction.options, options);
    });
    if (started)
        return nullptr;
    JobSpec spec;
    spec.kind = JobKind::Predict;
    spec.label = "Predicting sizes";
    spec.run = [scene, options](const JobContext&) -> Result<JobResult> {
        return JobResult(
            PredictedSizes{scene, options, std::make_shared<const ByteModel>(scene, options)});
    };
    predictions_.push_back({scene, options, jobs_.start(std::move(spec))});
    return nullptr;
}

void LaneWorker::forgetPrediction(JobId job) {
    std::erase_if(predictions_,
                  [job](const Prediction& prediction) { return prediction.job == job; });
}

void LaneWorker::commitPrediction(Document& document, FinishedJob& finished) {
    if (!finished.result) {
        report(document, Severity::Error, finished.result.error().message);
        return;
    }
    auto& sizes = std::get<PredictedSizes>(*finished.result);
    forgetPrediction(finished.id);
    byte_models_.insert(sizes.scene, sizes.options, std::move(sizes.model));
}

void LaneWorker::markCancelled(Document& document, LaneId lane_id) {
    const auto found = work_.find(lane_id);
    if (found == work_.end())
        return;
    found->second.job = 0;
    found->second.reading.reset();
    const BuildKey key = found->second.key;
    for (Lane& lane : document.lanes) {
        Work& work = work_[lane.id];
        if (lane.settings.algorithm && work.key == key && work.job == 0)
            work.failure = Failure{lane.revision, "cancelled; change a setting or retry"};
    }
}

void LaneWorker::retry(LaneId lane) {
    if (const auto found = work_.find(lane); found != work_.end())
        found->second.failure.reset();
}

bool LaneWorker::Shown::matches(const Shown& other) const {
    return source == other.source && bytes == other.bytes && position == other.position && target &&
           other.target && sameTarget(*target, *other.target);
}

ReadOut LaneWorker::readOut(const Shown& wanted, const Lod* previous, const JobContext& job) {
    const auto start = std::chrono::steady_clock::now();
    const LodSource& source = *wanted.source;
    ReadOut result;
    if (wanted.position)
        result.resolved.position = std::min(*wanted.position, source.positionCount() - 1);
    else
        result.resolved = source.resolveWithin(*wanted.target, *wanted.bytes, job);
    const std::uint64_t at = result.resolved.position;
    result.lod = std::make_shared<const Lod>(source.readOutWithin(at, previous, job));
    if (job.stopRequested())
        return result;
    result.predicted_bytes = wanted.bytes->bytes(source.shapeAt(at));
    result.error_estimate = source.errorAt(at);
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
}

bool LaneWorker::slide(const Document& document, Lane& lane, Work& work, const Shown& wanted) {
    const bool slides = lane.slides && wanted.target && !wanted.position &&
                        wanted.target->kind == Target::Kind::Ratio;
    if (!slides || (work.slid && work.shown.matches(wanted)))
        return false;
    ReadOut between;
    between.lod = work.slide.at(wanted.source, wanted.target->value);
    if (!between.lod)
        return false;
    between.resolved.position = between.lod->position;
    between.predicted_bytes = wanted.bytes->bytes(wanted.source->shapeAt(between.lod->position));
    between.error_estimate = wanted.source->errorAt(between.lod->position);
    work.reading = wanted;
    commitReadOut(document, lane, work, std::move(between), LodPlace::Between);
    return true;
}

bool LaneWorker::show(const Document& document, Lane& lane, Work& work, Shown wanted) {
    if (work.shown.matches(wanted) && !(work.slid && !lane.slides))
        return false;
    const bool shares = work.shown.source == wanted.source && !work.slid;
    const Lod* const previous = shares ? lane.status.lod.get() : nullptr;
    ReadOut read_out = readOut(wanted, previous, {});
    work.reading = std::move(wanted);
    commitReadOut(document, lane, work, std::move(read_out), LodPlace::AtPosition);
    return true;
}

bool LaneWorker::showOneShot(Lane& lane, Work& work, Shown wanted) {
    if (work.job != 0)
        return refreshBuilding(lane, work.job);
    if (work.shown.matches(wanted))
        return setState(lane, LaneState::Ready, 1.0);
    JobSpec spec;
    spec.kind = JobKind::Prepare;
    spec.lane = lane.id;
    spec.revision = lane.revision;
    spec.label = fmt::format("Computing {}", laneName(lane.settings));
    spec.run = [wanted](const JobContext& context) -> Result<JobResult> {
        ReadOut read_out = readOut(wanted, nullptr, context);
        if (context.stopRequested())
            return cancelled();
        return JobResult(std::move(read_out));
    };
    work.job = jobs_.start(std::move(spec));
    work.reading = std::move(wanted);
    return refreshBuilding(lane, work.job);
}

void LaneWorker::commitReadOut(
    const Document& document, Lane& lane, Work& work, ReadOut read_out, LodPlace place) {
    LaneStatus& status = lane.status;
    const LodSourcePtr& source = work.reading->source;
    const bool same_source = work.shown.source == source;
    // Between two positions it may name that of the LOD shown: it is another all the same.
    const bool was_between = std::exchange(work.slid, place == LodPlace::Between);
    if (work.slid || was_between || !same_source || !status.lod ||
        status.lod->position != read_out.lod->position) {
        jobs_.cancel(lane.id, JobKind::Measure);
        status.measuring = false;
        setShown(document, lane, std::move(read_out.lod));
    }
    if (status.scene != source->scene()) {
        status.error_map = {}; // of other submeshes
        jobs_.cancel(lane.id, JobKind::ErrorMap);
    }
    status.source = source;
    status.scene = source->scene();
    status.build_seconds = source->seconds_sequence + source->seconds_schedule;
    status.numbers.kept_bytes = read_out.predicted_bytes;
    status.numbers.predicted_bytes = status.numbers.kept_bytes;
    status.numbers.error_estimate = read_out.error_estimate;
    status.numbers.note = std::move(read_out.resolved.note);
    status.readout_ms = read_out.seconds * 1000.0;
    work.shown = std::move(*work.reading);
    work.shows_key = true;
    work.reading.reset();
}

} // namespace lodestone
