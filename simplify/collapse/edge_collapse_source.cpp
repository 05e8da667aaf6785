#include "simplify/collapse/edge_collapse_source.h"

#include "simplify/bake/bake.h"
#include "simplify/collapse/read_ends.h"
#include "simplify/collapse/seam_count.h"
#include "simplify/geomorph.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// What seams may do, as CollapseOptions::seams says.
enum class Seams : std::uint8_t { Strict, MayGo };

class EdgeCollapseSource final : public LodSource, public GeomorphSource {
public:
    EdgeCollapseSource(std::shared_ptr<const SequenceSet> set,
                       Seams seams,
                       const ScheduleOptions& options,
                       const ByteModel* bytes)
        : set_(std::move(set)), seams_(seams), options_(options), schedule_(*set_, options, bytes) {
    }

    const ScenePtr& scene() const override { return set_->scene; }

    std::uint64_t positionCount() const override { return schedule_.positionCount(); }

    std::uint64_t trianglesAt(std::uint64_t position) const override {
        return schedule_.trianglesAt(position);
    }

    double errorAt(std::uint64_t position) const override { return schedule_.errorAt(position); }

    LodShape shapeAt(std::uint64_t position) const override;
    Resolved resolve(const Target& target, const ByteModel& bytes) const override;
    Lod readOut(std::uint64_t position, const Lod* previous) const override;
    Geomorph geomorph(std::uint64_t fine, std::uint64_t coarse) const override;

    LodSourcePtr rescheduled(const ScheduleOptions& options,
                             const ByteModel& bytes) const override {
        const auto start = std::chrono::steady_clock::now();
        auto other = std::make_shared<EdgeCollapseSource>(set_, seams_, options, &bytes);
        other->seconds_sequence = seconds_sequence;
        other->seconds_schedule = secondsSince(start);
        return other;
    }

    std::vector<std::string> notes() const override { return set_->notes; }

    Result<BakedScene>
    transferred(const Lod& lod, const BakeOptions& options, const JobContext& job) const override;

private:
    // The first position that fits, by bisection; positionCount() if none does.
    template <class Fits>
    std::uint64_t firstThat(Fits fits) const {
        std::uint64_t low = 0;
        std::uint64_t high = positionCount();
        while (low < high) {
            const std::uint64_t middle = low + (high - low) / 2;
            if (fits(middle))
                high = middle;
            else
                low = middle + 1;
        }
        return low;
    }

    std::string whyMissed() const;
    std::string whatSeamsHold() const;
    void fillSubmesh(std::size_t s, SubmeshState state, Lod& lod) const;
    double growthOf(std::size_t s, SubmeshState state) const;

    std::shared_ptr<const SequenceSet> set_;
    Seams seams_;
    ScheduleOptions options_;
    Schedule schedule_;
};

LodShape EdgeCollapseSource::shapeAt(std::uint64_t position) const {
    LodShape shape;
    shape.submeshes.resize(set_->sequences.size());
    for (std::size_t s = 0; s < shape.submeshes.size(); ++s) {
        const CollapseSequence& sequence = set_->sequences[s];
        const SubmeshState state = schedule_.stateAt(s, position);
        LodShape::SubmeshShape& to = shape.submeshes[s];
        to.kept_instances = state.kept_instances;
        to.instance_order = set_->removals[s].order;
        const std::vector<Primitive>& primitives = set_->scene->submeshes[s].primitives;
        const bool grown = state.kept_instances < set_->ranges[s].size();
        to.changed = state.step > 0 || grown;
        for (std::size_t p = 0; p < primitives.size(); ++p) {
            const Geometry& own = *primitives[p].geometry;
            if (!to.changed || primitives[p].mode != PrimitiveMode::Triangles)
                to.primitives.push_back({static_cast<std::uint32_t>(own.positions.size()),
                                         static_cast<std::uint32_t>(own.indices.size())});
            else
                to.primitives.push_back({sequence.counts[p].wedges[state.step],
                                         3 * sequence.counts[p].faces[state.step]});
        }
    }
    return shape;
}

// How many of the vertices that are left lie on seams that must stay.
std::string EdgeCollapseSource::whatSeamsHold() const {
    SeamCount all;
    for (std::size_t s = 0; s < set_->sequences.size(); ++s) {
        const SubmeshState state = schedule_.stateAt(s, positionCount() - 1);
        const SeamCount count =
            countOnSeams(set_->sequences[s], set_->scene->submeshes[s], state.step);
        all.vertices += count.vertices;
        all.on_seams += count.on_seams;
    }
    if (all.on_seams == 0)
        return {};
    const double percent =
        100.0 * static_cast<double>(all.on_seams) / static_cast<double>(all.vertices);
    return ", or held by its seams: " + std::to_string(std::lround(percent)) +
           " % of remaining vertices lie on seams; a higher 'seams' lets their corners go";
}

std::string EdgeCollapseSource::whyMissed() const {
    const bool locked = std::ranges::find(options_.locked, true) != options_.locked.end();
    std::string why =
        "target not reached: every submesh is at its floor (at least 4 triangles, one instance)";
    if (locked)
        why += " or locked";
    return seams_ == Seams::Strict ? why + whatSeamsHold() : why;
}

Resolved EdgeCollapseSource::resolve(const Target& target, const ByteModel& bytes) const {
    const auto full = static_cast<double>(trianglesAt(0));
    const std::uint64_t last = positionCount() - 1;
    std::uint64_t position = 0;
    switch (target.kind) {
    case Target::Kind::Ratio:
    case Target::Kind::Triangles: {
        const double limit =
            target.kind == Target::Kind::Ratio ? target.value * full : target.value;
        position = firstThat([&](std::uint64_t p) {
            return static_cast<double>(trianglesAt(p)) <= limit + std::min(1e-9 * full, 0.5);
        });
        break;
    }
    case Target::Kind::Bytes:
        position = firstThat([&](std::uint64_t p) {
            return static_cast<double>(bytes.bytes(shapeAt(p))) <= target.value;
        });
        break;
    case Target::Kind::Error: // the coarsest whose error is within the target
        position = firstThat([&](std::uint64_t p) { return errorAt(p) > target.value; });
        return {position == 0 ? 0 : position - 1, true, {}};
    }
    if (position > last)
        return {last, false, whyMissed()};
    return {position, true, {}};
}

void EdgeCollapseSource::fillSubmesh(std::size_t s, SubmeshState state, Lod& lod) const {
    const Submesh& submesh = set_->scene->submeshes[s];
    const RemovalSequence& removal = set_->removals[s];
    LodSubmesh& to = lod.submeshes[s];
    to.kept_instances = state.kept_instances;
    to.instance_order = removal.order;
    if (state.step == 0 && state.kept_instances == set_->ranges[s].size()) {
        for (const Primitive& primitive : submesh.primitives)
            to.primitives.push_back(primitive.geometry);
        return;
    }
    to.primitives =
        readOutSubmesh(set_->sequences[s], submesh, state.step, growthOf(s, state), removal.pivot);
}

double EdgeCollapseSource::growthOf(std::size_t s, SubmeshState state) const {
    const RemovalSequence& removal = set_->removals[s];
    return removal.possible() ? growthAt(removal, state.kept_instances) : 1.0;
}

Lod EdgeCollapseSource::readOut(std::uint64_t position, const Lod* previous) const {
    Lod lod;
    lod.position = position;
    lod.submeshes.resize(set_->sequences.size());
    tbb::parallel_for(std::size_t{0}, lod.submeshes.size(), [&](std::size_t s) {
        const SubmeshState state = schedule_.stateAt(s, position);
        // The same state means the same geometry: nothing to build, nothing to upload.
        if (previous && schedule_.stateAt(s, previous->position) == state)
            lod.submeshes[s] = previous->submeshes[s];
        else
            fillSubmesh(s, state, lod);
    });
    for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
        const SubmeshState state = schedule_.stateAt(s, position);
        const std::uint64_t faces = set_->sequences[s].facesAt(state.step);
        lod.unique_triangles += faces;
        lod.triangles += faces * state.kept_instances;
        lod.instances += state.kept_instances;
    }
    return lod;
}

Geomorph EdgeCollapseSource::geomorph(std::uint64_t fine, std::uint64_t coarse) const {
    Geomorph geomorph;
    geomorph.fine = readOut(fine, nullptr);
    geomorph.ends.resize(geomorph.fine.submeshes.size());
    tbb::parallel_for(std::size_t{0}, geomorph.ends.size(), [&](std::size_t s) {
        const SubmeshState from = schedule_.stateAt(s, fine);
        const SubmeshState to = schedule_.stateAt(s, coarse);
        if (from == to)
            return;
        const CollapseSequence& sequence = set_->sequences[s];
        const Submesh& submesh = set_->scene->submeshes[s];
        const glm::dvec3& pivot = set_->removals[s].pivot;
        // What the file has may be in other vertices than the sequence, which cleans it.
        geomorph.fine.submeshes[s].primitives =
            readOutSubmesh(sequence, submesh, from.step, growthOf(s, from), pivot);
        geomorph.ends[s] =
            readOutEnds(sequence, submesh, {from.step, to.step}, growthOf(s, to), pivot);
    });
    return geomorph;
}

Result<BakedScene> EdgeCollapseSource::transferred(const Lod& lod,
                                                   const BakeOptions& options,
                                                   const JobContext& job) const {
    std::vector<BakeSubmesh> submeshes(set_->sequences.size());
    for (std::size_t s = 0; s < submeshes.size(); ++s) {
        const SubmeshState state = schedule_.stateAt(s, lod.position);
        submeshes[s] = {&set_->sequences[s],
                        state.step,
                        growthOf(s, state),
                        set_->removals[s].pivot,
                        set_->max_stretch[s]};
    }
    return bakeTextures(*set_->scene, lod, submeshes, options, job);
}

// Sets set.max_stretch, too.
std::vector<SequenceRequest> requestsFor(SequenceSet& set, const EdgeCollapseOptions& options) {
    const Scene& scene = *set.scene;
    std::vector<SequenceRequest> requests(scene.submeshes.size());
    set.max_stretch.resize(requests.size());
    std::vector<std::vector<Posture>> postures(requests.size());
    if (options.collapse.attributes.motion > 0.0)
        postures = deformingPostures(scene);
    tbb::parallel_for(std::size_t{0}, requests.size(), [&](std::size_t s) {
        requests[s].submesh = &scene.submeshes[s];
        requests[s].postures = std::move(postures[s]);
        requests[s].instance_count = set.ranges[s].size();
        std::vector<glm::dmat3> linear_parts;
        linear_parts.reserve(set.ranges[s].size());
        for (std::uint32_t i = set.ranges[s].begin; i < set.ranges[s].end; ++i)
            linear_parts.emplace_back(scene.instances[i].transform);
        InstanceWeights weights(linear_parts);
        set.max_stretch[s] = weights.maxStretch();
        if (options.weigh_instances)
            requests[s].weights = std::move(weights);
    });
    return requests;
}

enum class RemovalRule : std::uint8_t { ByCost, ByPaper };

void planRemovals(SequenceSet& set, const Bounds& bounds, RemovalRule rule, const JobContext& job) {
    constexpr double kCoverTolerance = 2e-4; // of the diagonal
    if (std::ranges::none_of(set.ranges, [](InstanceRange range) { return range.size() > 1; }))
        return;
    std::vector<SubmeshFacts> facts(set.ranges.size());
    tbb::parallel_for(std::size_t{0}, facts.size(), [&](std::size_t s) {
        facts[s] = factsOf(*set.scene, set.scene->submeshes[s], set.ranges[s].size());
    });
    const std::vector<Cover> covers =
        findCovers(*set.scene, set.ranges, facts, set.sequences, kCoverTolerance * set.diagonal);
    const std::size_t in_all = set.scene->instances.size();
    tbb::parallel_for(std::size_t{0}, covers.size(), [&](std::size_t s) {
        const InstanceRange range = set.ranges[s];
        const bool thinned = rule == RemovalRule::ByCost || isCrowd(range.size(), in_all);
        if (range.size() < 2 || !thinned || job.stopRequested())
            return;
        set.removals[s] = planRemoval(*set.scene, range, facts[s], bounds, covers[s]);
        if (rule == RemovalRule::ByPaper)
            putOff(set.removals[s]);
    });
}

} // namespace

Result<LodSourcePtr> prepareEdgeCollapse(ScenePtr scene,
                                         const EdgeCollapseOptions& options,
                                         const ScheduleOptions& schedule,
                                         const JobContext& job) {
    const auto start = std::chrono::steady_clock::now();
    auto set = std::make_shared<SequenceSet>();
    set->scene = std::move(scene);
    set->notes = options.notes;
    set->ranges = instanceRanges(*set->scene);
    const Bounds bounds = robustWorldBounds(*set->scene);
    set->diagonal = bounds.diagonal() > 0.0 ? bounds.diagonal() : 1.0;
    const std::vector<SequenceRequest> requests = requestsFor(*set, options);
    Result<std::vector<CollapseSequence>> sequences =
        buildSequences(requests, options.collapse, options.floors, job);
    if (!sequences)
        return tl::unexpected(sequences.error());
    set->sequences = std::move(*sequences);
    set->removals.resize(requests.size());
    if (options.remove_instances)
        planRemovals(*set,
                     bounds,
                     options.remove_by_paper ? RemovalRule::ByPaper : RemovalRule::ByCost,
                     job);
    if (job.stopRequested())
        return cancelled();
    const double sequence_seconds = secondsSince(start);
    const auto schedule_start = std::chrono::steady_clock::now();
    std::optional<ByteModel> bytes; // costs as much as a small scene's sequences
    if (schedule.ordering == Ordering::Byte)
        bytes.emplace(set->scene, ExportOptions{});
    auto source = std::make_shared<EdgeCollapseSource>(set,
                                                       options.collapse.seams > 0.0 ? Seams::MayGo
                                                                                    : Seams::Strict,
                                                       schedule,
                                                       bytes ? &*bytes : nullptr);
    source->seconds_sequence = sequence_seconds;
    source->seconds_schedule = secondsSince(schedule_start);
    return source;
}

} // namespace lodestone
