#include "simplify/pointcloud/point_cloud_source.h"

#include "simplify/pointcloud/cloud_submesh.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::uint64_t kRungs = 4096;   // values of the main parameter
constexpr std::uint64_t kAnchors = 16;   // rungs tried in advance, evenly
constexpr double kDistanceDecades = 5.0; // from the lowest rung to the highest

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What all sources of a scene and a method's options share.
struct CloudInput {
    ScenePtr scene;
    PointCloudOptions options;
    std::vector<CloudSubmesh> submeshes;
    double diagonal = 1.0;
};

// A computed position.
struct CloudLod {
    Lod lod;
    LodShape shape;
    double error_percent = 0.0;
};

using CloudLodPtr = std::shared_ptr<const CloudLod>;

struct Counted {
    double triangles = 0.0;
    double error_percent = 0.0;
};

// The last computed positions, and what is known of all that ever were. Thread-safe.
class CloudLodCache {
public:
    std::optional<Counted> counted(std::uint64_t position) const {
        const std::scoped_lock lock(mutex_);
        const auto found = counted_.find(position);
        return found == counted_.end() ? std::nullopt : std::optional(found->second);
    }

    CloudLodPtr find(std::uint64_t position) const {
        const std::scoped_lock lock(mutex_);
        const auto found =
            std::ranges::find_if(kept_, [&](const auto& k) { return k->lod.position == position; });
        return found == kept_.end() ? nullptr : *found;
    }

    void insert(CloudLodPtr lod) {
        const std::scoped_lock lock(mutex_);
        counted_[lod->lod.position] = {static_cast<double>(lod->lod.triangles), lod->error_percent};
        kept_triangles_ += lod->lod.unique_triangles;
        kept_.push_back(std::move(lod));
        while (kept_.size() > kMostLods || (kept_.size() > 2 && kept_triangles_ > kMostTriangles)) {
            kept_triangles_ -= kept_.front()->lod.unique_triangles;
            kept_.pop_front();
        }
    }

private:
    static constexpr std::size_t kMostLods = 24;
    static constexpr std::uint64_t kMostTriangles = 4'000'000;

    mutable std::mutex mutex_;
    std::deque<CloudLodPtr> kept_;
    std::uint64_t kept_triangles_ = 0;
    std::map<std::uint64_t, Counted> counted_;
};

// From that rung on too few triangles would be left: the coarsest allowed stands in.
struct Floor {
    std::uint64_t rung = ~std::uint64_t{0};
    CloudPiece piece;
};

class PointCloudSource final : public LodSource {
public:
    PointCloudSource(std::shared_ptr<const CloudInput> input, const ScheduleOptions& schedule)
        : input_(std::move(input)), schedule_(schedule), floors_(input_->submeshes.size()) {}

    // The slow part. False if cancelled.
    bool tryAnchors(const JobContext& job);

    const ScenePtr& scene() const override { return input_->scene; }

    std::uint64_t positionCount() const override { return lastPosition() + 1; }

    std::uint64_t trianglesAt(std::uint64_t position) const override {
        return static_cast<std::uint64_t>(countedAt(position).triangles);
    }

    double errorAt(std::uint64_t position) const override {
        return countedAt(position).error_percent;
    }

    LodShape shapeAt(std::uint64_t position) const override { return at(position)->shape; }

    Resolved resolve(const Target& target, const ByteModel& bytes) const override;

    Lod readOut(std::uint64_t position, const Lod*) const override { return at(position)->lod; }

    LodSourcePtr rescheduled(const ScheduleOptions& options, const ByteModel&) const override;

    std::vector<std::string> notes() const override { return {}; }

private:
    bool isGiven() const { return input_->options.main > 0.0; }

    std::uint64_t lastPosition() const {
        return isGiven() ? 1 : kRungs + input_->options.method->further_passes;
    }

    double rungValue(std::uint64_t rung) const;
    CloudSettings settingsOfRung(std::uint64_t rung) const;
    CloudPiece simplified(std::size_t s, CloudSettings settings, const JobContext& job) const;
    CloudPiece
    pieceAt(std::size_t s, std::uint64_t position, const JobContext& job, Floor* floor) const;
    CloudPiece coarsestAllowed(std::size_t s, std::uint64_t rung, const JobContext& job) const;
    // floors: where to note that a submesh has reached its own; null: they are known.
    CloudLodPtr
    compute(std::uint64_t position, const JobContext& job, std::vector<Floor>* floors) const;
    CloudLodPtr at(std::uint64_t position) const;
    Counted countedAt(std::uint64_t position) const;

    template <class Measure>
    std::uint64_t firstAtMost(double limit, Measure measure) const;
    std::string whyMissed() const;

    std::shared_ptr<const CloudInput> input_;
    ScheduleOptions schedule_;
    std::vector<Floor> floors_; // [submeshes]
    mutable CloudLodCache cache_;
};

double PointCloudSource::rungValue(std::uint64_t rung) const {
    const CloudMethod& method = *input_->options.method;
    const double along = static_cast<double>(std::min(rung, kRungs)) / static_cast<double>(kRungs);
    switch (method.main) {
    case MainParameter::Coverage:
        return method.maximum * along;
    case MainParameter::AngleDeg: // surfaces are mostly flat: fine steps there
        return method.maximum * along * along;
    case MainParameter::DistancePct:
        break;
    }
    return method.maximum * std::pow(10.0, kDistanceDecades * (along - 1.0));
}

CloudSettings PointCloudSource::settingsOfRung(std::uint64_t rung) const {
    CloudSettings settings = input_->options.settings;
    settings.main = rungValue(rung);
    if (rung > kRungs)
        settings.passes += static_cast<std::uint32_t>(rung - kRungs);
    return settings;
}

// settings.main as the parameter has it: distances in % of the diagonal.
CloudPiece
PointCloudSource::simplified(std::size_t s, CloudSettings settings, const JobContext& job) const {
    const CloudSubmesh& submesh = input_->submeshes[s];
    const CloudMethod& method = *input_->options.method;
    if (!schedule_.importance.empty())
        settings.main /= schedule_.importance[s];
    if (method.main == MainParameter::DistancePct)
        settings.main *= 0.01 * input_->diagonal / submesh.stretch;
    return simplifyPiece(submesh, method, settings, job);
}

std::uint32_t floorOf(const CloudSubmesh& submesh) {
    return std::min(4u, static_cast<std::uint32_t>(submesh.surface.faces.size()));
}

// The rungs below that one, by bisection on whether enough triangles are left.
CloudPiece
PointCloudSource::coarsestAllowed(std::size_t s, std::uint64_t rung, const JobContext& job) const {
    const CloudSubmesh& submesh = input_->submeshes[s];
    CloudPiece best = originalPiece(submesh);
    std::uint64_t low = 0; // allowed
    while (rung - low > 1 && !job.stopRequested()) {
        const std::uint64_t middle = low + (rung - low) / 2;
        CloudPiece piece = simplified(s, settingsOfRung(middle), job);
        if (piece.triangles >= floorOf(submesh)) {
            best = std::move(piece);
            low = middle;
        } else {
            rung = middle;
        }
    }
    return best;
}

CloudPiece PointCloudSource::pieceAt(std::size_t s,
                                     std::uint64_t position,
                                     const JobContext& job,
                                     Floor* floor) const {
    const CloudSubmesh& submesh = input_->submeshes[s];
    const bool locked = !schedule_.locked.empty() && schedule_.locked[s];
    if (position == 0 || locked || submesh.surface.faces.empty())
        return originalPiece(submesh);
    CloudSettings settings = settingsOfRung(position);
    std::uint64_t rung = position;
    if (isGiven()) {
        settings = input_->options.settings;
        settings.main = input_->options.main;
        for (rung = kRungs; rung > 0 && rungValue(rung) > settings.main;)
            --rung;
    }
    const Floor& known = floor ? *floor : floors_[s];
    if (rung >= known.rung)
        return known.piece;
    CloudPiece piece = simplified(s, settings, job);
    if (piece.triangles >= floorOf(submesh))
        return piece;
    piece = coarsestAllowed(s, rung, job);
    if (floor)
        *floor = {rung, piece};
    return piece;
}

CloudLodPtr PointCloudSource::compute(std::uint64_t position,
                                      const JobContext& job,
                                      std::vector<Floor>* floors) const {
    const std::size_t count = input_->submeshes.size();
    std::vector<CloudPiece> pieces(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t s) {
        pieces[s] = pieceAt(s, position, job, floors ? &(*floors)[s] : nullptr);
    });
    auto made = std::make_shared<CloudLod>();
    Lod& lod = made->lod;
    lod.position = position;
    lod.submeshes.resize(count);
    for (std::size_t s = 0; s < count; ++s) {
        const CloudSubmesh& submesh = input_->submeshes[s];
        lod.submeshes[s].primitives = std::move(pieces[s].primitives);
        lod.submeshes[s].kept_instances = submesh.instances;
        lod.instances += submesh.instances;
        lod.triangles += std::uint64_t{pieces[s].triangles} * submesh.instances;
        lod.unique_triangles += submesh.instances > 0 ? pieces[s].triangles : 0;
        made->error_percent = std::max(
            made->error_percent, 100.0 * pieces[s].error * submesh.stretch / input_->diagonal);
    }
    made->shape = shapeOf(*input_->scene, lod);
    return made;
}

CloudLodPtr PointCloudSource::at(std::uint64_t position) const {
    position = std::min(position, lastPosition());
    CloudLodPtr made = cache_.find(position);
    if (!made) {
        made = compute(position, {}, nullptr);
        cache_.insert(made);
    }
    return made;
}

Counted PointCloudSource::countedAt(std::uint64_t position) const {
    position = std::min(position, lastPosition());
    if (const std::optional<Counted> known = cache_.counted(position))
        return *known;
    const CloudLodPtr made = at(position);
    return {static_cast<double>(made->lod.triangles), made->error_percent};
}

bool PointCloudSource::tryAnchors(const JobContext& job) {
    const std::uint64_t step = isGiven() ? 1 : kRungs / kAnchors;
    for (std::uint64_t position = 0; position <= lastPosition(); position += step) {
        const CloudLodPtr made = compute(position, job, &floors_);
        if (job.stopRequested())
            return false;
        cache_.insert(made);
        job.report(static_cast<double>(position) / static_cast<double>(lastPosition()));
    }
    return true;
}

// The first position whose measure is at most the limit; positionCount() if there is none. Anchors
// first, then between two of them where a straight line would meet the limit, every third time in
// the middle. The same positions are tried whatever was tried before.
template <class Measure>
std::uint64_t PointCloudSource::firstAtMost(double limit, Measure measure) const {
    const std::uint64_t step = isGiven() ? 1 : kRungs / kAnchors;
    std::uint64_t low = 0;
    double low_value = measure(low);
    if (low_value <= limit)
        return low;
    std::uint64_t high = std::min(step, lastPosition());
    double high_value = measure(high);
    while (high_value > limit) {
        if (high == lastPosition())
            return positionCount();
        low = high;
        low_value = high_value;
        high = std::min(high + step, lastPosition());
        high_value = measure(high);
    }
    for (int round = 1; high - low > 1; ++round) {
        const double along = round % 3 == 0 ? 0.5 : (low_value - limit) / (low_value - high_value);
        const auto inside = static_cast<double>(high - low);
        const auto offset = static_cast<std::uint64_t>(std::clamp(along * inside, 1.0, inside - 1));
        const double value = measure(low + offset);
        if (value <= limit) {
            high = low + offset;
            high_value = value;
        } else {
            low = low + offset;
            low_value = value;
        }
    }
    return high;
}

std::string PointCloudSource::whyMissed() const {
    const CloudMethod& method = *input_->options.method;
    const std::string start = "target not reached: ";
    if (isGiven())
        return start + std::string(method.main_id) + " is set; 0 lets it follow the target";
    return start + std::to_string(trianglesAt(lastPosition())) +
           " triangles are the fewest that this method leaves (at least 4 a submesh)";
}

Resolved PointCloudSource::resolve(const Target& target, const ByteModel& bytes) const {
    const double full = countedAt(0).triangles;
    std::uint64_t position = 0;
    bool met = true;
    const auto triangles = [&](std::uint64_t p) { return countedAt(p).triangles; };
    const auto size = [&](std::uint64_t p) { return static_cast<double>(bytes.bytes(shapeAt(p))); };
    switch (target.kind) {
    case Target::Kind::Ratio:
    case Target::Kind::Triangles: {
        const double limit =
            target.kind == Target::Kind::Ratio ? target.value * full : target.value;
        position = firstAtMost(limit + std::min(1e-9 * full, 0.5), triangles);
        break;
    }
    case Target::Kind::Bytes:
        position = firstAtMost(target.value, size);
        break;
    case Target::Kind::Error: { // the coarsest whose error is within the target
        const auto minus_error = [&](std::uint64_t p) { return -countedAt(p).error_percent; };
        const double above = std::nextafter(target.value, HUGE_VAL);
        position = firstAtMost(-above, minus_error);
        position = position == 0 ? 0 : position - 1;
        break;
    }
    }
    met = position <= lastPosition();
    position = std::min(position, lastPosition());
    if (isGiven()) { // that value, whatever the target
        met = position == 0 || met;
        position = 1;
    }
    return {position, met, met ? std::string() : whyMissed()};
}

LodSourcePtr PointCloudSource::rescheduled(const ScheduleOptions& options, const ByteModel&) const {
    const auto start = std::chrono::steady_clock::now();
    auto other = std::make_shared<PointCloudSource>(input_, options);
    other->tryAnchors({});
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
    auto input = std::make_shared<CloudInput>();
    input->options = options;
    const Bounds bounds = robustWorldBounds(*scene);
    input->diagonal = bounds.diagonal() > 0.0 ? bounds.diagonal() : 1.0;
    const std::vector<InstanceRange> ranges = instanceRanges(*scene);
    input->submeshes.resize(scene->submeshes.size());
    tbb::parallel_for(std::size_t{0}, ranges.size(), [&](std::size_t s) {
        const std::span<const Instance> instances(scene->instances);
        input->submeshes[s] = makeCloudSubmesh(
            scene->submeshes[s], instances.subspan(ranges[s].begin, ranges[s].size()), job);
    });
    input->scene = std::move(scene);
    if (job.stopRequested())
        return cancelled();
    auto source = std::make_shared<PointCloudSource>(std::move(input), schedule);
    if (!source->tryAnchors(job))
        return cancelled();
    source->seconds_sequence = secondsSince(start);
    return source;
}

} // namespace lodestone
