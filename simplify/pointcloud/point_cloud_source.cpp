#include "simplify/pointcloud/point_cloud_source.h"

#include "simplify/pointcloud/cloud_cache.h"
#include "simplify/pointcloud/cloud_ladder.h"
#include "simplify/pointcloud/rung_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <tbb/parallel_for.h>
#include <tbb/parallel_for_each.h>

namespace lodestone {

namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct PointCloudInput {
    CloudScenePtr cloud;
    PointCloudOptions options;
    ScheduleOptions schedule;
};

class PointCloudSource final : public LodSource {
public:
    explicit PointCloudSource(PointCloudInput input)
        : cloud_(std::move(input.cloud)), options_(input.options),
          schedule_(std::move(input.schedule)), ladder_(*options_.method),
          keeps_shapes_(options_.settings.fidelity == Fidelity::Sound &&
                        std::ranges::any_of(cloud_->submeshes, [](const CloudSubmesh& submesh) {
                            return submesh.instances > 1;
                        })) {}

    const CloudScenePtr& cloud() const { return cloud_; }

    // The slow part: what every target needs. False if cancelled.
    bool begin(const JobContext& job);

    const ScenePtr& scene() const override { return cloud_->scene; }

    std::uint64_t positionCount() const override { return lastPosition() + 1; }

    std::uint64_t trianglesAt(std::uint64_t position) const override {
        return countsAt(position, {})->triangles;
    }

    double errorAt(std::uint64_t position) const override {
        return countsAt(position, {})->error_percent;
    }

    LodShape shapeAt(std::uint64_t position) const override {
        return countsAt(position, {})->shape;
    }

    Resolved resolve(const Target& target, const ByteModel& bytes) const override {
        return resolveWithin(target, bytes, {});
    }

    Lod readOut(std::uint64_t position, const Lod* previous) const override {
        return readOutWithin(position, previous, {});
    }

    Resolved resolveWithin(const Target& target,
                           const ByteModel& bytes,
                           const JobContext& job) const override;
    // What was found comes at once when it is asked for again.
    Lod readOutWithin(std::uint64_t position,
                      const Lod* previous,
                      const JobContext& job) const override;
    LodSourcePtr rescheduled(const ScheduleOptions& options, const ByteModel&) const override;

    std::vector<std::string> notes() const override { return {}; }

private:
    bool isGiven() const { return options_.main > 0.0; }

    // Above the ladder's rungs they come again, for targets that no shape can be kept for.
    std::uint64_t lastPosition() const {
        return isGiven() ? 1 : ladder_.last() * (keeps_shapes_ ? 2 : 1);
    }

    CloudDraft simplified(std::size_t s, CloudSettings settings, const JobContext& job) const;
    CloudDraft draftOf(std::size_t s,
                       std::uint64_t position,
                       const CloudDrafts* shaped,
                       const JobContext& job) const;
    CloudDraft draftWithin(std::size_t s,
                           const CloudSettings& settings,
                           CloudFloor floor,
                           const JobContext& job) const;
    CloudDraft coarsestAllowed(std::size_t s, CloudFloor floor, const JobContext& job) const;
    CloudCountsPtr countsOf(const CloudDrafts& drafts) const;
    CloudDraftsPtr draftsAt(std::uint64_t position, const JobContext& job) const;
    CloudCountsPtr countsAt(std::uint64_t position, const JobContext& job) const;
    RungBracket search(const std::function<double(std::uint64_t)>& excess, double tolerance) const;
    std::uint64_t
    positionFor(const Target& target, const ByteModel& bytes, const JobContext& job) const;
    std::string whyMissed() const;

    CloudScenePtr cloud_;
    PointCloudOptions options_;
    ScheduleOptions schedule_;
    CloudLadder ladder_;
    bool keeps_shapes_ = false; // before the floor is a number of triangles alone
    mutable CloudCache cache_;
};

// settings.main as the parameter has it: distances in % of the diagonal.
CloudDraft
PointCloudSource::simplified(std::size_t s, CloudSettings settings, const JobContext& job) const {
    const CloudSubmesh& submesh = cloud_->submeshes[s];
    if (!schedule_.importance.empty())
        settings.main /= schedule_.importance[s];
    if (options_.method->main == MainParameter::DistancePct)
        settings.main *= 0.01 * cloud_->diagonal / submesh.stretch;
    return draftPiece(submesh, *options_.method, settings, job);
}

// By bisection over the rungs on whether the floor is kept.
CloudDraft
PointCloudSource::coarsestAllowed(std::size_t s, CloudFloor floor, const JobContext& job) const {
    if (const std::optional<CloudDraft> known = cache_.coarsest(s, floor))
        return *known;
    const CloudSubmesh& submesh = cloud_->submeshes[s];
    CloudDraft best = originalDraft(submesh);
    std::uint64_t low = 0; // allowed
    std::uint64_t high = isGiven() ? ladder_.rungOf(options_.main) : ladder_.last();
    while (high - low > 1 && !job.stopRequested()) {
        const std::uint64_t middle = low + (high - low) / 2;
        CloudDraft draft = simplified(s, ladder_.settingsOf(middle, options_.settings), job);
        if (keepsFloor(submesh, draft, floor)) {
            best = std::move(draft);
            low = middle;
        } else {
            high = middle;
        }
    }
    if (!job.stopRequested())
        cache_.insertCoarsest(s, floor, best);
    return best;
}

CloudDraft PointCloudSource::draftWithin(std::size_t s,
                                         const CloudSettings& settings,
                                         CloudFloor floor,
                                         const JobContext& job) const {
    CloudDraft draft = simplified(s, settings, job);
    return keepsFloor(cloud_->submeshes[s], draft, floor) ? draft : coarsestAllowed(s, floor, job);
}

// shaped: those of the last rung, where position is beyond it.
CloudDraft PointCloudSource::draftOf(std::size_t s,
                                     std::uint64_t position,
                                     const CloudDrafts* shaped,
                                     const JobContext& job) const {
    const CloudSubmesh& submesh = cloud_->submeshes[s];
    const bool locked = !schedule_.locked.empty() && schedule_.locked[s];
    if (position == 0 || locked || submesh.surface.faces.empty())
        return originalDraft(submesh);
    const CloudFloor floor = keeps_shapes_ ? CloudFloor::Shape : CloudFloor::Triangles;
    if (isGiven()) {
        CloudSettings settings = options_.settings;
        settings.main = options_.main;
        return draftWithin(s, settings, floor, job);
    }
    const auto settings_at = [&](std::uint64_t rung) {
        return ladder_.settingsOf(rung, options_.settings);
    };
    if (!shaped)
        return draftWithin(s, settings_at(position), floor, job);
    CloudDraft coarser =
        draftWithin(s, settings_at(position - ladder_.last()), CloudFloor::Triangles, job);
    return coarser.triangles < shaped->submeshes[s].triangles ? coarser : shaped->submeshes[s];
}

CloudCountsPtr PointCloudSource::countsOf(const CloudDrafts& drafts) const {
    auto counts = std::make_shared<CloudCounts>();
    for (std::size_t s = 0; s < drafts.submeshes.size(); ++s) {
        const CloudSubmesh& submesh = cloud_->submeshes[s];
        const CloudDraft& draft = drafts.submeshes[s];
        counts->shape.submeshes.push_back(
            {draft.shape, submesh.instances, draft.surface != nullptr, nullptr});
        counts->triangles += std::uint64_t{draft.triangles} * submesh.instances;
        counts->error_percent = std::max(counts->error_percent,
                                         100.0 * draft.error * submesh.stretch / cloud_->diagonal);
    }
    return counts;
}

// Null where asked to stop.
CloudDraftsPtr PointCloudSource::draftsAt(std::uint64_t position, const JobContext& job) const {
    if (CloudDraftsPtr known = cache_.drafts(position))
        return known;
    CloudDraftsPtr shaped;
    if (!isGiven() && position > ladder_.last()) {
        shaped = draftsAt(ladder_.last(), job);
        if (!shaped)
            return nullptr;
    }
    auto drafts = std::make_shared<CloudDrafts>();
    drafts->position = position;
    drafts->submeshes.resize(cloud_->submeshes.size());
    tbb::parallel_for(std::size_t{0}, drafts->submeshes.size(), [&](std::size_t s) {
        drafts->submeshes[s] = draftOf(s, position, shaped.get(), job);
    });
    if (job.stopRequested())
        return nullptr;
    cache_.insert(drafts, countsOf(*drafts));
    return drafts;
}

// Of the input where asked to stop.
CloudCountsPtr PointCloudSource::countsAt(std::uint64_t position, const JobContext& job) const {
    position = std::min(position, lastPosition());
    if (CloudCountsPtr known = cache_.counts(position))
        return known;
    const CloudDraftsPtr drafts = draftsAt(position, job);
    return drafts ? countsOf(*drafts) : countsAt(0, {});
}

Lod PointCloudSource::readOutWithin(std::uint64_t position,
                                    const Lod* /*previous*/,
                                    const JobContext& job) const {
    position = std::min(position, lastPosition());
    if (const LodPtr known = cache_.lod(position))
        return *known;
    const CloudDraftsPtr drafts = draftsAt(position, job);
    if (!drafts)
        return {};
    auto lod = std::make_shared<Lod>();
    lod->position = position;
    lod->submeshes.resize(drafts->submeshes.size());
    tbb::parallel_for(std::size_t{0}, drafts->submeshes.size(), [&](std::size_t s) {
        LodSubmesh& to = lod->submeshes[s];
        to.primitives = finishPiece(cloud_->submeshes[s], drafts->submeshes[s], job).primitives;
        to.kept_instances = cloud_->submeshes[s].instances;
    });
    for (std::size_t s = 0; s < drafts->submeshes.size(); ++s) {
        const std::uint64_t instances = cloud_->submeshes[s].instances;
        lod->instances += instances;
        lod->triangles += drafts->submeshes[s].triangles * instances;
        lod->unique_triangles += instances > 0 ? drafts->submeshes[s].triangles : 0;
    }
    if (!job.stopRequested())
        cache_.insert(lod);
    return *lod;
}

bool PointCloudSource::begin(const JobContext& job) {
    const std::vector<std::uint64_t> first =
        isGiven() ? std::vector<std::uint64_t>{1} : ladder_.usualRungs(*cloud_);
    tbb::parallel_for_each(first, [&](std::uint64_t position) { draftsAt(position, job); });
    job.report(1.0);
    return !job.stopRequested();
}

RungBracket PointCloudSource::search(const std::function<double(std::uint64_t)>& excess,
                                     double tolerance) const {
    RungSearch search;
    search.last = lastPosition();
    if (!isGiven())
        search.first = ladder_.usualRungs(*cloud_);
    search.tolerance = tolerance;
    search.excess = [&excess](std::uint64_t rung) {
        constexpr double kMost = 50.0; // of logarithms that count; where a measure is zero
        const double value = excess(rung);
        return value > -kMost ? std::min(value, kMost) : -kMost; // nothing of nothing is enough
    };
    return searchRungs(search);
}

// lastPosition() + 1: none meets the target. Triangles fall about as powers of the distances do,
// and so do bytes: they are straight in the rung as logarithms.
std::uint64_t PointCloudSource::positionFor(const Target& target,
                                            const ByteModel& bytes,
                                            const JobContext& job) const {
    constexpr double kNearEnough = 0.005; // relative
    constexpr double kLeast = 1e-300;     // a target of nothing has a logarithm, too
    const auto full = static_cast<double>(countsAt(0, job)->triangles);
    switch (target.kind) {
    case Target::Kind::Ratio:
    case Target::Kind::Triangles: {
        const double wanted =
            target.kind == Target::Kind::Ratio ? target.value * full : target.value;
        const double limit = std::max(kLeast, wanted + std::min(1e-9 * full, 0.5));
        const auto excess = [&](std::uint64_t position) {
            return std::log(static_cast<double>(countsAt(position, job)->triangles) / limit);
        };
        return search(excess, kNearEnough).coarse;
    }
    case Target::Kind::Bytes: {
        const auto excess = [&](std::uint64_t position) {
            const auto size = static_cast<double>(bytes.bytes(countsAt(position, job)->shape));
            return std::log(size / std::max(kLeast, target.value));
        };
        return search(excess, kNearEnough).coarse;
    }
    case Target::Kind::Error:
        break;
    }
    const double above = std::nextafter(target.value, HUGE_VAL);
    const auto excess = [&](std::uint64_t position) {
        return std::log(above / countsAt(position, job)->error_percent);
    };
    return search(excess, 0.0).fine; // the coarsest whose error is within the target
}

std::string PointCloudSource::whyMissed() const {
    const std::string start = "target not reached: ";
    if (isGiven())
        return start + std::string(options_.method->main_id) +
               " is set; 0 lets it follow the target";
    return start + std::to_string(trianglesAt(lastPosition())) +
           " triangles are the fewest that this method leaves (" +
           std::string(options_.method->keeps) + ")";
}

Resolved PointCloudSource::resolveWithin(const Target& target,
                                         const ByteModel& bytes,
                                         const JobContext& job) const {
    std::uint64_t position = positionFor(target, bytes, job);
    if (job.stopRequested())
        return {};
    bool met = position <= lastPosition();
    position = std::min(position, lastPosition());
    if (isGiven()) { // that value, whatever the target
        met = position == 0 || met;
        position = 1;
    }
    return {position, met, met ? std::string() : whyMissed()};
}

Result<LodSourcePtr> sourceOf(PointCloudInput input,
                              std::chrono::steady_clock::time_point start,
                              const JobContext& job) {
    if (job.stopRequested())
        return cancelled();
    auto source = std::make_shared<PointCloudSource>(std::move(input));
    if (!source->begin(job))
        return cancelled();
    source->seconds_sequence = secondsSince(start);
    return source;
}

LodSourcePtr PointCloudSource::rescheduled(const ScheduleOptions& options, const ByteModel&) const {
    const auto start = std::chrono::steady_clock::now();
    auto other = std::make_shared<PointCloudSource>(PointCloudInput{cloud_, options_, options});
    other->begin({});
    other->seconds_sequence = seconds_sequence;
    other->seconds_schedule = secondsSince(start);
    return other;
}

} // namespace

Result<LodSourcePtr> preparePointCloud(ScenePtr scene,
                                       const PointCloudOptions& options,
                                       const ScheduleOptions& schedule,
                                       const JobContext& job) {
    const auto start = std::chrono::steady_clock::now();
    CloudScenePtr cloud = makeCloudScene(std::move(scene), job);
    return sourceOf({std::move(cloud), options, schedule}, start, job);
}

Result<LodSourcePtr> preparePointCloudLike(const LodSource& other,
                                           const PointCloudOptions& options,
                                           const ScheduleOptions& schedule,
                                           const JobContext& job) {
    const auto* like = dynamic_cast<const PointCloudSource*>(&other);
    if (!like)
        return preparePointCloud(other.scene(), options, schedule, job);
    return sourceOf({like->cloud(), options, schedule}, std::chrono::steady_clock::now(), job);
}

} // namespace lodestone
