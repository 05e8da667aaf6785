#include "simplify/collapse/sequence.h"

#include "scene/radix_sort.h"
#include "simplify/collapse/collapse_method.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace lodestone {

std::uint32_t CollapseSequence::facesAt(std::uint32_t step) const {
    std::uint32_t faces = step == 0 ? complex.dropped_faces : 0;
    for (const PrimitiveCounts& primitive : counts)
        faces += primitive.faces[step];
    return faces;
}

// --- joining

namespace {

// Order of all steps: entries are component-major, so equal keys keep (component, step).
// Result: for each component-major entry its step number, from `first_step` on.
std::vector<std::uint32_t> orderSteps(std::span<const CollapseLog> logs,
                                      std::span<const double> cost_scales,
                                      std::uint32_t first_step) {
    std::size_t total = 0;
    for (const CollapseLog& log : logs)
        total += log.cost.size();
    std::vector<std::uint64_t> keys;
    keys.reserve(total);
    for (std::size_t c = 0; c < logs.size(); ++c) {
        double running = 0.0; // a dear head holds back the cheap steps behind it
        for (const float cost : logs[c].cost) {
            running = std::max(running, static_cast<double>(cost) * cost_scales[c]);
            // The double without its sign and lowest bits: every scale, to seven digits.
            const std::uint64_t bits = std::bit_cast<std::uint64_t>(running) >> 31;
            keys.push_back(bits << 32 | keys.size());
        }
    }
    if (logs.size() > 1)
        sortByUpperHalf(keys);
    std::vector<std::uint32_t> step_of(total);
    for (std::size_t i = 0; i < total; ++i)
        step_of[keys[i] & 0xFFFFFFFFu] = first_step + static_cast<std::uint32_t>(i);
    return step_of;
}

void countAlive(CollapseSequence& sequence) {
    const Complex& complex = sequence.complex;
    const std::size_t steps = sequence.cost.size();
    const auto fill = [&](std::vector<std::uint32_t>& alive,
                          const std::vector<std::uint32_t>& death,
                          std::uint32_t begin,
                          std::uint32_t end) {
        alive.assign(steps + 1, 0);
        for (std::uint32_t i = begin; i < end; ++i)
            if (death[i] != kNone)
                ++alive[death[i]];
        std::uint32_t left = end - begin;
        for (std::uint32_t& count : alive)
            count = left -= count;
    };
    sequence.counts.resize(complex.face_begin.size() - 1);
    for (std::size_t p = 0; p + 1 < complex.face_begin.size(); ++p) {
        fill(sequence.counts[p].faces,
             sequence.face_death,
             complex.face_begin[p],
             complex.face_begin[p + 1]);
        fill(sequence.counts[p].wedges,
             sequence.wedge_death,
             complex.wedge_begin[p],
             complex.wedge_begin[p + 1]);
    }
}

// Where each component's entries begin in component-major arrays.
struct LogOffsets {
    std::vector<std::size_t> steps;
    std::vector<std::size_t> kills;
};

LogOffsets offsetsOf(std::span<const CollapseLog> logs) {
    LogOffsets offsets{{0}, {0}};
    for (const CollapseLog& log : logs) {
        offsets.steps.push_back(offsets.steps.back() + log.cost.size());
        offsets.kills.push_back(offsets.kills.back() + log.kill_order.size());
    }
    return offsets;
}

void joinLifetimes(CollapseSequence& sequence,
                   const CollapseLog& log,
                   const std::uint32_t* step_of, // of the log's step s at s - 1
                   std::size_t kill_at) {
    const auto global = [&](std::uint32_t step) {
        return step == kNone ? kNone : step_of[step - 1];
    };
    for (std::size_t f = 0; f < log.faces.size(); ++f)
        sequence.face_death[log.faces[f]] = global(log.face_death[f]);
    for (std::size_t w = 0; w < log.wedges.size(); ++w) {
        sequence.wedge_death[log.wedges[w]] = global(log.wedge_death[w]);
        const std::uint32_t parent = log.wedge_parent[w];
        sequence.wedge_parent[log.wedges[w]] = parent == kNone ? kNone : log.wedges[parent];
    }
    for (const std::uint32_t wedge : log.kill_order)
        sequence.kill_order[kill_at++] = log.wedges[wedge];
    for (const std::uint32_t wedge : log.version_wedge)
        ++sequence.version_begin[log.wedges[wedge] + 1];
}

// version_begin holds the starts; at: next free place of each wedge.
void joinVersions(CollapseSequence& sequence,
                  const CollapseLog& log,
                  const std::uint32_t* step_of,
                  std::vector<std::uint32_t>& at) {
    const std::uint32_t size = sequence.attributes.size;
    for (std::size_t v = 0; v < log.version_wedge.size(); ++v) {
        const std::uint32_t to = at[log.wedges[log.version_wedge[v]]]++;
        sequence.version_step[to] = step_of[log.version_step[v] - 1];
        sequence.version_position[to] = log.version_position[v];
        if (!log.version_carrier.empty())
            sequence.version_carrier[to] = log.wedges[log.version_carrier[v]];
        if (!log.version_values.empty())
            std::copy_n(log.version_values.begin() + static_cast<std::ptrdiff_t>(v * size),
                        size,
                        sequence.version_values.begin() +
                            static_cast<std::ptrdiff_t>(std::size_t{to} * size));
    }
}

} // namespace

CollapseSequence joinLogs(Complex complex,
                          WedgeAttributes attributes,
                          std::vector<CollapseLog> logs,
                          std::span<const double> cost_scales,
                          std::span<const double> length_scales) {
    CollapseSequence sequence;
    sequence.complex = std::move(complex);
    sequence.attributes = std::move(attributes);
    sequence.attributes.values = {};
    sequence.attributes.charts = {};
    // Cleaning (degenerate faces, doubles) is a step of its own, free of cost.
    const std::uint32_t cleaning = sequence.complex.dropped_faces > 0 ? 1 : 0;
    const LogOffsets offsets = offsetsOf(logs);
    const std::vector<std::uint32_t> step_of = orderSteps(logs, cost_scales, 1 + cleaning);
    sequence.cost.resize(step_of.size() + cleaning);
    sequence.error.resize(sequence.cost.size());
    sequence.face_death.assign(sequence.complex.faces.size(), kNone);
    const std::size_t wedges = sequence.complex.wedge_source.size();
    sequence.wedge_death.assign(wedges, kNone);
    sequence.wedge_parent.assign(wedges, kNone);
    sequence.kill_order.resize(offsets.kills.back());
    sequence.kill_begin.assign(offsets.kills.begin(), offsets.kills.end());
    sequence.version_begin.assign(wedges + 1, 0);
    tbb::parallel_for(std::size_t{0}, logs.size(), [&](std::size_t c) {
        const std::uint32_t* steps = step_of.data() + offsets.steps[c];
        for (std::size_t s = 0; s < logs[c].cost.size(); ++s) {
            sequence.cost[steps[s] - 1] = static_cast<double>(logs[c].cost[s]) * cost_scales[c];
            sequence.error[steps[s] - 1] = static_cast<float>(
                std::sqrt(static_cast<double>(logs[c].error2[s])) * length_scales[c]);
        }
        joinLifetimes(sequence, logs[c], steps, offsets.kills[c]);
    });
    std::partial_sum(sequence.version_begin.begin(),
                     sequence.version_begin.end(),
                     sequence.version_begin.begin());
    const std::size_t versions = sequence.version_begin.back();
    sequence.version_step.resize(versions);
    sequence.version_position.resize(versions);
    sequence.version_values.resize(versions * sequence.attributes.size);
    sequence.version_carrier.resize(sequence.attributes.carries ? versions : 0);
    std::vector<std::uint32_t> at(sequence.version_begin.begin(), sequence.version_begin.end() - 1);
    tbb::parallel_for(std::size_t{0}, logs.size(), [&](std::size_t c) {
        joinVersions(sequence, logs[c], step_of.data() + offsets.steps[c], at);
        logs[c] = {};
    });
    countAlive(sequence);
    sequence.step_count = sequence.recordedSteps();
    return sequence;
}

// --- building

namespace {

// One submesh while its components are being collapsed.
struct Build {
    Complex complex;
    WedgeAttributes attributes;
    std::vector<CollapseLog> logs;     // [components]
    std::vector<double> cost_scales;   // [components]
    std::vector<double> length_scales; // [components]
    std::unique_ptr<tbb::enumerable_thread_specific<std::unique_ptr<ComponentCollapser>>> workers;
};

// Neighbouring components that one worker takes together.
struct Batch {
    std::size_t build = 0;
    std::size_t begin = 0;
    std::size_t end = 0;
    std::uint32_t faces = 0;
};

std::vector<Batch> makeBatches(std::span<const Build> builds) {
    constexpr std::uint32_t kBatchFaces = 16'384;
    std::vector<Batch> batches;
    for (std::size_t b = 0; b < builds.size(); ++b) {
        const std::vector<std::uint32_t>& begin = builds[b].complex.component_begin;
        Batch batch{b, 0, 0, 0};
        for (std::size_t c = 0; c + 1 < begin.size(); ++c) {
            batch.faces += begin[c + 1] - begin[c];
            batch.end = c + 1;
            if (batch.faces >= kBatchFaces || c + 2 == begin.size()) {
                batches.push_back(batch);
                batch = {b, c + 1, c + 1, 0};
            }
        }
    }
    std::ranges::stable_sort(batches, std::greater{}, &Batch::faces); // the largest first
    return batches;
}

class GreedyCollapser final : public ComponentCollapser {
public:
    GreedyCollapser(const Build& build,
                    const SequenceRequest& request,
                    const CollapseOptions& options)
        : options_(options), mesh_(build.complex, request.weights, build.attributes, options) {}

    bool collapse(std::size_t component, const CollapseWatch& watch) override {
        mesh_.load(component);
        if (mesh_.liveFaces() > options_.near_greedy_above &&
            !collapseNearGreedy(mesh_, options_.exact_below, watch))
            return false;
        return collapseExactGreedy(mesh_, watch);
    }

    ComponentMesh& mesh() override { return mesh_; }

private:
    const CollapseOptions& options_;
    ComponentMesh mesh_;
};

std::unique_ptr<ComponentCollapser>
makeCollapser(const Build& build, const SequenceRequest& request, const CollapseOptions& options) {
    if (options.method)
        return options.method->collapser(build.complex, request, build.attributes, options);
    return std::make_unique<GreedyCollapser>(build, request, options);
}

bool runBatch(const Batch& batch,
              Build& build,
              const SequenceRequest& request,
              const CollapseOptions& options,
              const CollapseWatch& watch) {
    std::unique_ptr<ComponentCollapser>& worker = build.workers->local();
    if (!worker)
        worker = makeCollapser(build, request, options);
    for (std::size_t c = batch.begin; c < batch.end; ++c) {
        if (!worker->collapse(c, watch))
            return false;
        ComponentMesh& mesh = worker->mesh();
        build.cost_scales[c] = mesh.costScale() * request.weights.scale() * request.world_weight;
        build.length_scales[c] = std::sqrt(std::sqrt(mesh.costScale()));
        build.logs[c] = mesh.takeLog();
    }
    return true;
}

} // namespace

Result<std::vector<CollapseSequence>> buildSequences(std::span<const SequenceRequest> requests,
                                                     const CollapseOptions& options,
                                                     const FloorOptions& floors,
                                                     const JobContext& job) {
    std::vector<Build> builds(requests.size());
    tbb::parallel_for(std::size_t{0}, builds.size(), [&](std::size_t b) {
        if (job.stopRequested())
            return;
        Build& build = builds[b];
        build.complex = buildComplex(*requests[b].submesh, job);
        if (job.stopRequested())
            return;
        if (options.method)
            options.method->arrange(build.complex, requests[b], job);
        if (job.stopRequested())
            return;
        build.attributes = gatherAttributes(*requests[b].submesh, build.complex);
        build.attributes.extremes =
            extremeVertices(build.complex, build.attributes, requests[b].postures);
        if (options.attributes.texcoord > 0.0)
            build.attributes.charts = gatherCharts(build.complex, build.attributes);
        build.logs.resize(build.complex.componentCount());
        build.cost_scales.resize(build.logs.size());
        build.length_scales.resize(build.logs.size());
        build.workers = std::make_unique<
            tbb::enumerable_thread_specific<std::unique_ptr<ComponentCollapser>>>();
    });
    if (job.stopRequested())
        return cancelled();
    const std::vector<Batch> batches = makeBatches(builds);
    std::uint64_t faces = 0;
    for (const Batch& batch : batches)
        faces += batch.faces;
    std::atomic<std::uint64_t> faces_gone{0};
    const CollapseWatch watch{job, faces_gone, faces};
    std::atomic<bool> stopped{false};
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, batches.size(), 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
            for (std::size_t i = range.begin(); i != range.end() && !stopped; ++i) {
                const std::size_t b = batches[i].build;
                if (!runBatch(batches[i], builds[b], requests[b], options, watch))
                    stopped = true;
            }
        },
        tbb::simple_partitioner{});
    if (stopped || job.stopRequested())
        return cancelled();
    std::vector<CollapseSequence> sequences(requests.size());
    tbb::parallel_for(std::size_t{0}, builds.size(), [&](std::size_t b) {
        Build& build = builds[b];
        build.workers.reset();
        sequences[b] = joinLogs(std::move(build.complex),
                                std::move(build.attributes),
                                std::move(build.logs),
                                build.cost_scales,
                                build.length_scales);
        sequences[b].step_count =
            floorStep(sequences[b], *requests[b].submesh, requests[b].instance_count, floors);
        if (options.grow_crowds)
            sequences[b].crowds = growCrowds(sequences[b], *requests[b].submesh);
    });
    job.report(1.0);
    return sequences;
}

} // namespace lodestone
