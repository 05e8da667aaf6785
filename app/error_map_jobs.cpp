#include "app/error_map_jobs.h"

#include <algorithm>
#include <fmt/core.h>

namespace lodestone {

bool ErrorMapJobs::wants(const Document& document, const Lane& lane) const {
    const LaneStatus& status = lane.status;
    if (!status.lod || status.state != LaneState::Ready ||
        status.error_map.lod_revision == status.lod_revision)
        return false;
    const auto given_up = given_up_.find(lane.id);
    if (given_up != given_up_.end() && given_up->second == status.lod_revision)
        return false;
    return std::ranges::none_of(document.jobs, [&](const JobStatus& job) {
        return job.kind == JobKind::ErrorMap && job.lane == lane.id;
    });
}

void ErrorMapJobs::start(const Document& document) {
    if (document.view.compare != CompareMode::HeatMap)
        return;
    for (const Lane& lane : document.lanes) {
        if (!wants(document, lane))
            continue;
        JobSpec spec;
        spec.kind = JobKind::ErrorMap;
        spec.lane = lane.id;
        spec.revision = lane.status.lod_revision;
        spec.label = fmt::format("Error map of {}", laneName(lane.settings));
        spec.run = [input = ErrorMapInput{document.scene, lane.status.scene, lane.status.lod}](
                       const JobContext& context) -> Result<JobResult> {
            Result<ErrorMap> map = makeErrorMap(input, context);
            if (!map)
                return tl::unexpected<Error>(std::move(map.error()));
            return JobResult(std::move(*map));
        };
        jobs_.start(std::move(spec));
    }
}

void ErrorMapJobs::commit(Document& document, FinishedJob& finished) {
    Lane* const lane = document.findLane(finished.lane);
    if (!lane)
        return;
    if (!finished.result) {
        given_up_[lane->id] = finished.revision;
        report(document, Severity::Error, finished.result.error().message);
        return;
    }
    auto& map = std::get<ErrorMap>(*finished.result);
    lane->status.error_map = std::move(map);
    lane->status.error_map.lod_revision = finished.revision;
}

void ErrorMapJobs::cancelled(const Document& document, LaneId lane_id) {
    if (const Lane* const lane = document.findLane(lane_id))
        given_up_[lane_id] = lane->status.lod_revision;
}

} // namespace lodestone
