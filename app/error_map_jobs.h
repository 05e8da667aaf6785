#pragma once
// The jobs that make lanes' error maps while the heat map is shown. Main thread only.
#include "app/jobs.h"

#include <map>

namespace lodestone {

class ErrorMapJobs {
public:
    explicit ErrorMapJobs(JobQueue& jobs) : jobs_(jobs) {}

    // In the heat map's mode: for lanes whose LOD has none yet, one job at a time for each. While a
    // target is dragged, every finished map is shown before the next is begun.
    void start(const Document& document);
    // A finished ErrorMap job.
    void commit(Document& document, FinishedJob& finished);
    // The user cancelled one: not tried again until the lane shows another LOD.
    void cancelled(const Document& document, LaneId lane);

private:
    bool wants(const Document& document, const Lane& lane) const;

    JobQueue& jobs_;
    std::map<LaneId, std::uint64_t> given_up_; // lod_revision
};

} // namespace lodestone
