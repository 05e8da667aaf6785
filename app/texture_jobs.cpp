#include "app/texture_jobs.h"

#include "simplify/bake/bake_parameters.h"
#include "simplify/bake/baked_size.h"

#include <algorithm>
#include <fmt/core.h>

namespace lodestone {

namespace {

// Updates a value and says whether it was another.
template <class T>
bool assign(T& value, T next) {
    if (value == next)
        return false;
    value = std::move(next);
    return true;
}

} // namespace

std::optional<BakeOptions> wantedTextures(const LaneSettings& settings) {
    if (!settings.algorithm)
        return std::nullopt;
    return bakeOptions(*settings.algorithm, settings.parameters);
}

bool hasTextures(const LaneStatus& status, const BakeOptions& wanted) {
    return status.textures && status.textures->options == wanted &&
           status.textures->lod_revision == status.lod_revision;
}

bool TextureJobs::refresh(Document& document) {
    std::erase_if(work_, [&](const auto& item) {
        if (document.findLane(item.first))
            return false;
        jobs_.cancel(item.first, JobKind::Texture);
        return true;
    });
    bool changed = false;
    for (Lane& lane : document.lanes)
        changed |= refreshLane(document, lane);
    for (Lane& lane : document.lanes)
        changed |= refreshSize(document, wantedTextures(lane.settings), lane, work_[lane.id]);
    return changed;
}

void TextureJobs::stop(LaneId lane, Work& work) {
    if (work.job != 0)
        jobs_.cancel(lane, JobKind::Texture);
    work.job = 0;
}

bool TextureJobs::refreshLane(const Document& document, Lane& lane) {
    LaneStatus& status = lane.status;
    Work& work = work_[lane.id];
    const std::optional<BakeOptions> wanted = wantedTextures(lane.settings);
    if (!wanted) {
        stop(lane.id, work);
        work.failed = false;
        bool changed = assign(status.textures, LaneTexturesPtr());
        changed |= assign(status.texture_failure, std::string());
        return assign(status.texture_progress, std::optional<double>()) || changed;
    }
    const Key key{status.lod_revision, *wanted};
    if (work.job != 0 && !(work.key == key))
        stop(lane.id, work);
    if (!(work.key == key))
        work.failed = false;
    bool changed = !work.failed && assign(status.texture_failure, std::string());
    const bool settled = status.state == LaneState::Ready && status.source && status.lod &&
                         !lane.slides && !document.history.dragging();
    if (!hasTextures(status, *wanted) && settled && work.job == 0 && !work.failed)
        start(lane, work, key);
    std::optional<double> progress;
    if (work.job != 0) {
        const std::vector<JobStatus> jobs = jobs_.status();
        const auto job = std::ranges::find(jobs, work.job, &JobStatus::id);
        progress = job == jobs.end() ? 0.0 : job->progress;
    }
    return assign(status.texture_progress, progress) || changed;
}

bool TextureJobs::refreshSize(const Document& document,
                              const std::optional<BakeOptions>& wanted,
                              Lane& lane,
                              Work& work) {
    LaneStatus& status = lane.status;
    LaneNumbers& numbers = status.numbers;
    Sized sized;
    sized.kept_bytes = numbers.kept_bytes;
    if (wanted && status.lod) {
        sized.key = Key{status.lod_revision, *wanted};
        if (hasTextures(status, *wanted))
            sized.model = lanes_.byteModel(status.textures->baked.scene, document.export_options);
        if (sized.model)
            sized.textures = status.textures;
    }
    const bool estimated = sized.key && !sized.textures;
    if (!(sized == work.sized)) {
        work.bytes = sized.kept_bytes;
        if (sized.textures)
            work.bytes =
                sized.model->bytes(shapeOf(*sized.textures->baked.scene, *sized.textures->lod));
        else if (estimated)
            work.bytes = estimateBakedBytes(*status.scene, *status.lod, *wanted, work.bytes);
        work.sized = std::move(sized);
    }
    const bool changed = assign(numbers.predicted_bytes, work.bytes);
    return assign(numbers.bytes_estimated, estimated) || changed;
}

void TextureJobs::start(const Lane& lane, Work& work, const Key& key) {
    JobSpec spec;
    spec.kind = JobKind::Texture;
    spec.lane = lane.id;
    spec.revision = key.lod_revision;
    spec.label = fmt::format("Transferring textures of {}", laneName(lane.settings));
    spec.run =
        [input =
             LaneTexturesInput{lane.status.source, lane.status.lod, key.options, key.lod_revision}](
            const JobContext& context) -> Result<JobResult> {
        Result<LaneTexturesPtr> textures = makeLaneTextures(input, context);
        if (!textures)
            return tl::unexpected<Error>(std::move(textures.error()));
        return JobResult(std::move(*textures));
    };
    work.job = jobs_.start(std::move(spec));
    work.key = key;
    work.failed = false;
}

void TextureJobs::commit(Document& document, FinishedJob& finished) {
    Lane* const lane = document.findLane(finished.lane);
    const auto found = work_.find(finished.lane);
    if (!lane || found == work_.end() || found->second.job != finished.id)
        return;
    Work& work = found->second;
    work.job = 0;
    const std::optional<BakeOptions> wanted = wantedTextures(lane->settings);
    if (!wanted || !(work.key == Key{lane->status.lod_revision, *wanted}))
        return;
    if (finished.result) {
        lane->status.textures = std::get<LaneTexturesPtr>(*finished.result);
        for (const std::string& note : lane->status.textures->baked.notes)
            report(document, Severity::Info, fmt::format("{}: {}", laneName(lane->settings), note));
        return;
    }
    work.failed = true;
    lane->status.texture_failure = finished.result.error().message;
    report(document,
           Severity::Error,
           fmt::format("{}: {}", finished.label, lane->status.texture_failure));
}

void TextureJobs::cancelled(Document& document, LaneId lane_id) {
    const auto found = work_.find(lane_id);
    Lane* const lane = document.findLane(lane_id);
    if (found == work_.end() || !lane)
        return;
    found->second.job = 0;
    found->second.failed = true;
    lane->status.texture_failure = "cancelled";
}

void TextureJobs::retry(LaneId lane) {
    if (const auto found = work_.find(lane); found != work_.end())
        found->second.failed = false;
}

} // namespace lodestone
