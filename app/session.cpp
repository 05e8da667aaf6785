#include "app/session.h"

#include "app/error_map_jobs.h"
#include "app/json_text.h"
#include "app/lane_worker.h"
#include "app/recent.h"
#include "app/texture_jobs.h"
#include "scene/generate.h"
#include "scene/import.h"
#include "simplify/bake/baked_size.h"

#include <algorithm>
#include <chrono>
#include <fmt/core.h>
#include <spdlog/spdlog.h>

namespace lodestone {

namespace {

Result<JobResult> loadFile(const std::filesystem::path& path, const JobContext& context) {
    Result<ScenePtr> scene = importScene(path, context);
    if (!scene)
        return tl::unexpected<Error>(std::move(scene.error()));
    return JobResult(describeScene(std::move(*scene), path));
}

Result<JobResult> loadSample(const std::string& name, std::uint64_t seed) {
    Result<ScenePtr> scene = generateScene(name, seed);
    if (!scene)
        return tl::unexpected<Error>(std::move(scene.error()));
    return JobResult(describeScene(std::move(*scene), {}));
}

// What an export writes: what a lane shows or, where its textures are still to be transferred, what
// it will show then.
struct Written {
    DrawnLod shown;
    std::optional<LaneTexturesInput> textures;
};

Written writtenOf(const Lane& lane) {
    const LaneStatus& status = lane.status;
    const std::optional<BakeOptions> wanted = wantedTextures(lane.settings);
    if (!wanted || hasTextures(status, *wanted) || !status.source)
        return {drawnLod(status), std::nullopt};
    return {{}, LaneTexturesInput{status.source, status.lod, *wanted, status.lod_revision}};
}

Result<JobResult> writeLod(Written written,
                           const std::filesystem::path& path,
                           const ExportOptions& options,
                           PointOfNoReturn& no_return,
                           const JobContext& context) {
    std::vector<std::string> notes;
    if (written.textures) {
        const Result<LaneTexturesPtr> textures = makeLaneTextures(*written.textures, context);
        if (!textures)
            return tl::unexpected<Error>(textures.error());
        written.shown = {(*textures)->baked.scene, (*textures)->lod};
        notes = (*textures)->baked.notes;
    }
    const ExportGate gate{context.stop, [&no_return] { return no_return.pass(); }};
    Result<ExportReport> report =
        exportScene(*written.shown.scene, *written.shown.lod, path, options, gate);
    if (!report)
        return tl::unexpected<Error>(std::move(report.error()));
    report->notes.insert(report->notes.end(), notes.begin(), notes.end());
    return JobResult(std::move(*report));
}

Result<JobResult> measureLod(const ScenePtr& original,
                             const ScenePtr& scene,
                             const std::shared_ptr<const Lod>& lod,
                             const JobContext& context) {
    const Lod full = fullLod(*original);
    Result<Distance> distance =
        measureDistance({original.get(), &full}, {scene.get(), lod.get()}, {}, context);
    if (!distance)
        return tl::unexpected<Error>(std::move(distance.error()));
    return JobResult(*distance);
}

} // namespace

struct Session::Impl {
    Options options;
    Document document;
    UiLog log;
    JobQueue jobs;
    LaneWorker lanes;
    ErrorMapJobs error_maps;
    TextureJobs textures;
    std::map<JobId, std::filesystem::path> export_paths;
    std::map<JobId, std::uint64_t> export_revisions; // of the document at the start
    std::uint64_t logged_messages = 0;
    Framing framing;

    explicit Impl(Options session_options)
        : options(std::move(session_options)), log(options.log_file),
          jobs(options.worker_threads, options.wake), lanes(jobs), error_maps(jobs),
          textures(jobs, lanes) {
        if (!options.recent_file.empty())
            document.recent = readRecent(options.recent_file);
    }

    void load(std::string label, std::function<Result<JobResult>(const JobContext&)> work) {
        JobSpec spec;
        spec.kind = JobKind::Load;
        spec.label = std::move(label);
        spec.run = std::move(work);
        jobs.start(std::move(spec));
        document.load_state = LoadState::Loading;
    }

    void run(const OpenScene& command) {
        load(fmt::format("Opening {}", command.path.filename().string()),
             [path = command.path](const JobContext& context) { return loadFile(path, context); });
    }

    void run(const OpenSample& command) {
        load(fmt::format("Making {}", command.name),
             [name = command.name, seed = command.seed](const JobContext&) {
                 return loadSample(name, seed);
             });
    }

    void run(const Export& command) {
        const Lane* lane = document.findLane(command.lane);
        if (!lane || !lane->status.lod) {
            report(document, Severity::Warning, "this lane shows nothing yet; nothing exported");
            return;
        }
        JobSpec spec;
        spec.kind = JobKind::Export;
        spec.lane = lane->id;
        spec.label = fmt::format("Writing {}", command.path.filename().string());
        spec.no_return = std::make_shared<PointOfNoReturn>();
        spec.run = [written = writtenOf(*lane),
                    path = command.path,
                    export_options = document.export_options,
                    no_return = spec.no_return](const JobContext& context) {
            return writeLod(written, path, export_options, *no_return, context);
        };
        const JobId id = jobs.start(std::move(spec));
        export_paths[id] = command.path;
        export_revisions[id] = document.revision;
    }

    void run(const MeasureLane& command) {
        for (Lane& lane : document.lanes)
            if (command.lane == kNoLane || command.lane == lane.id)
                measure(lane);
    }

    void measure(Lane& lane) {
        if (!lane.status.lod || lane.status.distance)
            return;
        JobSpec spec;
        spec.kind = JobKind::Measure;
        spec.lane = lane.id;
        spec.revision = lane.status.lod_revision;
        spec.label = fmt::format("Measuring {}", laneName(lane.settings));
        spec.run = [original = document.scene, scene = lane.status.scene, lod = lane.status.lod](
                       const JobContext& context) {
            return measureLod(original, scene, lod, context);
        };
        jobs.start(std::move(spec));
        lane.status.measuring = true;
    }

    void run(const MeasureRates&) {
        for (Lane& lane : document.lanes)
            lane.status.rate_wanted = lane.status.lod != nullptr;
    }

    void run(const CancelJob& command) {
        for (Lane& lane : document.lanes)
            lane.status.rate_wanted = false;
        const std::vector<JobStatus> before = jobs.status();
        jobs.cancel(command.job);
        const std::vector<JobStatus> after = jobs.status();
        for (const JobStatus& job : before) {
            if (std::ranges::find(after, job.id, &JobStatus::id) != after.end())
                continue;
            afterCancel(job);
            report(document, Severity::Info, fmt::format("{}: cancelled", job.label));
        }
    }

    void afterCancel(const JobStatus& job) {
        if (job.kind == JobKind::ErrorMap)
            error_maps.cancelled(document, job.lane);
        if (job.kind == JobKind::Texture)
            textures.cancelled(document, job.lane);
        if (job.kind == JobKind::Prepare)
            lanes.markCancelled(document, job.lane);
        if (job.kind == JobKind::Predict)
            lanes.forgetPrediction(job.id);
        if (job.kind == JobKind::Load)
            document.load_state = document.scene ? LoadState::Loaded : LoadState::Empty;
        if (Lane* lane = document.findLane(job.lane); lane && job.kind == JobKind::Measure)
            lane->status.measuring = false;
        export_paths.erase(job.id);
        export_revisions.erase(job.id);
    }

    void run(const RetryLane& command) {
        lanes.retry(command.lane);
        textures.retry(command.lane);
    }

    void run(const FrameScene& command) {
        if (framing && document.scene)
            document.camera = framing(document, {});
        else
            applyCommand(document, command);
    }

    void run(const FrameSelection& command) {
        if (framing && document.scene)
            document.camera = framing(document, selectionBounds(document));
        else
            applyCommand(document, command);
    }

    template <class Edit>
    void run(const Edit& command) {
        applyCommand(document, command);
    }

    void commit(FinishedJob& finished) {
        switch (finished.kind) {
        case JobKind::Load:
            commitLoad(finished);
            break;
        case JobKind::Prepare:
        case JobKind::Predict:
            lanes.commit(document, finished);
            break;
        case JobKind::Export:
            commitExport(finished);
            break;
        case JobKind::Measure:
            commitMeasure(finished);
            break;
        case JobKind::ErrorMap:
            error_maps.commit(document, finished);
            break;
        case JobKind::Texture:
            textures.commit(document, finished);
            break;
        }
    }

    void commitLoad(FinishedJob& finished) {
        if (!finished.result) {
            document.load_state = document.scene ? LoadState::Loaded : LoadState::Empty;
            report(document, Severity::Error, finished.result.error().message);
            return;
        }
        resetDocument(document, std::move(std::get<LoadedScene>(*finished.result)));
        if (framing)
            document.camera.distance = 0.0; // framed once the views have their shape
        for (const std::string& note : document.scene->notes)
            report(document, Severity::Warning, note);
        if (document.path.empty())
            return;
        addRecent(document.recent, document.path);
        if (!options.recent_file.empty() && !writeRecent(options.recent_file, document.recent))
            spdlog::warn("cannot write {}", options.recent_file.string());
    }

    void commitExport(FinishedJob& finished) {
        const std::filesystem::path path = std::move(export_paths[finished.id]);
        const std::uint64_t revision = export_revisions[finished.id];
        export_paths.erase(finished.id);
        export_revisions.erase(finished.id);
        if (!finished.result) {
            report(document, Severity::Error, finished.result.error().message);
            return;
        }
        const auto& written = std::get<ExportReport>(*finished.result);
        document.last_export = path;
        document.saved_revision = revision;
        for (const std::string& note : written.notes)
            report(document, Severity::Info, note);
        report(document, // last, for the newest is what is shown
               Severity::Info,
               fmt::format("wrote {} ({} bytes)", path.string(), written.bytes));
    }

    void commitMeasure(FinishedJob& finished) {
        Lane* lane = document.findLane(finished.lane);
        if (!lane || lane->status.lod_revision != finished.revision)
            return;
        lane->status.measuring = false;
        if (finished.result)
            lane->status.distance = std::get<Distance>(*finished.result);
        else
            report(document, Severity::Error, finished.result.error().message);
    }

    void logState();
    void logLane(const Lane& lane, std::size_t index);
};

void Session::Impl::logLane(const Lane& lane, std::size_t index) {
    const LaneStatus& status = lane.status;
    const LaneNumbers& numbers = status.numbers;
    log.object(
        "lane",
        std::to_string(lane.id),
        fmt::format(
            "\"index\":{},\"algorithm\":{},\"state\":{},\"lod\":{},"
            "\"triangles\":{},\"unique_triangles\":{},\"instances\":{},"
            "\"ratio\":{:.6f},\"slides\":{},\"bytes\":{},\"measured\":{},\"rate\":{},\"error_"
            "map\":{},\"flip\":{:.6f},\"textures\":{},\"atlas\":{},\"exact\":{},\"note\":{}",
            index,
            jsonText(lane.settings.algorithm ? lane.settings.algorithm->id
                                             : std::string_view("original")),
            jsonText(laneStateName(status.state)),
            status.lod_revision,
            numbers.triangles,
            numbers.unique_triangles,
            numbers.instances,
            numbers.ratio,
            lane.slides,
            numbers.predicted_bytes,
            status.distance.has_value(),
            status.rate ? status.rate->frames : 0,
            status.error_map.lod_revision,
            status.flip.value_or(-1.0),
            status.textures ? status.textures->lod_revision : 0,
            status.textures ? status.textures->options.atlas_px : 0,
            !numbers.bytes_estimated,
            jsonText(numbers.note)));
}

namespace {

// [[submesh, instance], ...]; instance -1: all.
std::string selectionJson(const Document& document) {
    constexpr std::size_t kMost = 100;
    std::string json;
    for (std::size_t at = 0; at < std::min(kMost, document.selection.size()); ++at) {
        const SelectedItem& item = document.selection[at];
        const bool all = item.instance == kNone;
        json += fmt::format("{}[{},{}]",
                            at == 0 ? "" : ",",
                            item.submesh,
                            all ? -1 : static_cast<std::int64_t>(item.instance));
    }
    return "[" + json + "]";
}

} // namespace

void Session::Impl::logState() {
    if (!log.enabled())
        return;
    log.object("document",
               "document",
               fmt::format("\"path\":{},\"scene\":{},\"lanes\":{},\"jobs\":{},\"undo\":{},"
                           "\"redo\":{},\"active\":{},\"selection\":{}",
                           jsonText(document.path.string()),
                           jsonText(document.scene ? document.scene->name : std::string()),
                           document.lanes.size(),
                           document.jobs.size(),
                           jsonText(document.history.undoName()),
                           jsonText(document.history.redoName()),
                           document.active_lane,
                           selectionJson(document)));
    for (std::size_t index = 0; index < document.lanes.size(); ++index)
        logLane(document.lanes[index], index);
    for (const JobStatus& job : document.jobs)
        log.object("job",
                   std::to_string(job.id),
                   fmt::format("\"job\":{},\"lane\":{},\"running\":{}",
                               jsonText(jobKindName(job.kind)),
                               job.lane,
                               job.running));
    for (const Message& message : document.messages) {
        if (message.sequence <= logged_messages)
            continue;
        log.object("message",
                   std::to_string(message.sequence),
                   fmt::format("\"severity\":{},\"text\":{},\"count\":{}",
                               static_cast<int>(message.severity),
                               jsonText(message.text),
                               message.count));
    }
    for (const Message& message : document.messages)
        logged_messages = std::max(logged_messages, message.sequence);
}

Session::Session(Options options) : impl_(std::make_unique<Impl>(std::move(options))) {}

Session::~Session() = default;

const Document& Session::document() const {
    return impl_->document;
}

bool Session::update(CommandQueue& commands) {
    Impl& impl = *impl_;
    bool changed = !impl.document.jobs.empty(); // their progress moves
    for (const Command& command : commands.take()) {
        std::visit([&impl](const auto& value) { impl.run(value); }, command);
        changed = true;
    }
    for (FinishedJob& finished : impl.jobs.poll()) {
        impl.commit(finished);
        changed = true;
    }
    followView(impl.document);
    changed |= impl.lanes.refresh(impl.document);
    changed |= impl.textures.refresh(impl.document);
    impl.document.jobs = impl.jobs.status();
    impl.error_maps.start(impl.document);
    impl.document.jobs = impl.jobs.status();
    impl.logState();
    return changed || !impl.document.jobs.empty();
}

bool Session::updateUntilIdle(double timeout_s) {
    constexpr std::uint32_t kSliceMs = 5;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
    CommandQueue none;
    do {
        update(none);
        if (impl_->jobs.idle())
            return true;
        impl_->jobs.waitForFinished(kSliceMs);
    } while (std::chrono::steady_clock::now() < end);
    return false;
}

Session::PredictedSize Session::predictedSize(LaneId lane_id, const ExportOptions& options) {
    const Lane* lane = impl_->document.findLane(lane_id);
    if (!lane || !lane->status.lod)
        return {};
    const LaneStatus& status = lane->status;
    const std::optional<BakeOptions> wanted = wantedTextures(lane->settings);
    const bool bakes_first = wanted && !hasTextures(status, *wanted);
    const DrawnLod written = bakes_first ? DrawnLod{status.scene, status.lod} : drawnLod(status);
    const ByteModelPtr model = impl_->lanes.byteModel(written.scene, options);
    if (!model)
        return {};
    const std::uint64_t bytes = model->bytes(shapeOf(*written.scene, *written.lod));
    if (bakes_first)
        return {estimateBakedBytes(*status.scene, *status.lod, *wanted, bytes), true};
    return {bytes, isEstimated(options)};
}

void Session::setFrameTime(LaneId lane_id, double frame_ms) {
    if (Lane* lane = impl_->document.findLane(lane_id))
        lane->status.frame_ms = frame_ms;
}

void Session::setRate(LaneId lane_id, const std::optional<MeasuredRate>& rate) {
    if (Lane* lane = impl_->document.findLane(lane_id)) {
        lane->status.rate = rate;
        lane->status.rate_wanted = false;
    }
}

void Session::setFlip(LaneId lane_id, std::optional<double> flip) {
    if (Lane* lane = impl_->document.findLane(lane_id))
        lane->status.flip = flip;
}

void Session::setViewSide(double shorter_side_px) {
    impl_->document.view_side_px = shorter_side_px;
}

void Session::setFraming(Framing framing) {
    impl_->framing = std::move(framing);
}

void Session::reportError(std::string message) {
    report(impl_->document, Severity::Error, std::move(message));
}

UiLog& Session::uiLog() {
    return impl_->log;
}

} // namespace lodestone
