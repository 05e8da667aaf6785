#include "simplify/collapse/schedule.h"

#include <algorithm>
#include <queue>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

// A run of adjacent steps of one submesh that is scheduled as one.
struct Block {
    double cost = 0.0;
    double gain = 0.0;
    std::uint32_t steps = 0;

    double key() const { return gain > 0.0 ? cost / gain : cost > 0.0 ? kHuge : 0.0; }

    static constexpr double kHuge = 1e300;
};

// Rates of a submesh's steps for one ordering.
struct Rates {
    double per_vertex = 0.0;
    double per_triangle = 0.0;
    double per_instance = 0.0;
};

class StepReader {
public:
    StepReader(const SequenceSet& set,
               std::size_t submesh,
               const ScheduleOptions& options,
               const ByteModel* bytes)
        : sequence_(set.sequences[submesh]), removal_(set.removals[submesh]),
          instances_(set.ranges[submesh].size()), ordering_(options.ordering) {
        if (submesh < options.importance.size())
            importance_ = options.importance[submesh];
        if (ordering_ != Ordering::Byte)
            return;
        const auto s = static_cast<std::uint32_t>(submesh);
        for (std::uint32_t p = 0; p < sequence_.counts.size(); ++p)
            rates_.push_back({bytes->bytesPerVertex(s, p), bytes->bytesPerTriangle(s, p), 0.0});
        bytes_per_instance_ = bytes->bytesPerInstance(s);
    }

    std::uint32_t collapses() const { return instances_ > 0 ? sequence_.step_count : 0; }

    std::uint32_t stepCount() const {
        return collapses() + static_cast<std::uint32_t>(removal_.cost.size());
    }

    // Step numbers start at 0 here: step i leads from state i to state i + 1.
    Block read(std::uint32_t i) const {
        const bool collapse = i < collapses();
        const double cost =
            importance_ * (collapse ? sequence_.cost[i] : removal_.cost[i - collapses()]);
        return {cost, collapse ? collapseGain(i) : removalGain(), 1};
    }

    // Instanced triangles after i steps.
    std::uint64_t trianglesAfter(std::uint32_t i) const {
        const std::uint32_t step = std::min(i, collapses());
        return std::uint64_t{sequence_.facesAt(step)} * (instances_ - (i - step));
    }

    double errorOf(std::uint32_t i, double stretch) const {
        return i < collapses() ? static_cast<double>(sequence_.error[i]) * stretch
                               : static_cast<double>(removal_.error[i - collapses()]);
    }

private:
    double collapseGain(std::uint32_t i) const {
        if (ordering_ == Ordering::Cost)
            return 1.0;
        if (ordering_ == Ordering::Triangle)
            return static_cast<double>(sequence_.facesAt(i) - sequence_.facesAt(i + 1)) *
                   instances_;
        double saved = 0.0;
        for (std::size_t p = 0; p < rates_.size(); ++p) {
            const CollapseSequence::PrimitiveCounts& counts = sequence_.counts[p];
            saved += (counts.faces[i] - counts.faces[i + 1]) * rates_[p].per_triangle +
                     (counts.wedges[i] - counts.wedges[i + 1]) * rates_[p].per_vertex;
        }
        return saved;
    }

    double removalGain() const {
        if (ordering_ == Ordering::Cost)
            return 1.0;
        return ordering_ == Ordering::Triangle ? sequence_.facesAt(collapses())
                                               : bytes_per_instance_;
    }

    const CollapseSequence& sequence_;
    const RemovalSequence& removal_;
    std::uint32_t instances_;
    Ordering ordering_;
    double importance_ = 1.0;
    std::vector<Rates> rates_;
    double bytes_per_instance_ = 0.0;
};

// Pools adjacent violators: blocks of rising cost per gain. A cheap run behind one dear step, or a
// step that gains nothing (a vertex without faces), joins its neighbours.
// By cost alone nothing is averaged: a step waits for the dearest one before it (one global queue).
std::vector<Block> poolSteps(const StepReader& reader, Ordering ordering) {
    std::vector<Block> blocks;
    for (std::uint32_t i = 0; i < reader.stepCount(); ++i) {
        Block block = reader.read(i);
        if (ordering == Ordering::Cost) {
            if (!blocks.empty())
                block.cost = std::max(block.cost, blocks.back().cost);
            blocks.push_back(block);
            continue;
        }
        while (!blocks.empty() && blocks.back().key() >= block.key()) {
            block.cost += blocks.back().cost;
            block.gain += blocks.back().gain;
            block.steps += blocks.back().steps;
            blocks.pop_back();
        }
        blocks.push_back(block);
    }
    return blocks;
}

struct Head {
    double key = 0.0;
    std::uint32_t submesh = 0;

    bool operator>(const Head& other) const {
        return key != other.key ? key > other.key : submesh > other.submesh;
    }
};

} // namespace

Schedule::Schedule(const SequenceSet& set, const ScheduleOptions& options, const ByteModel* bytes)
    : set_(&set), positions_(set.sequences.size()) {
    std::vector<StepReader> readers;
    std::vector<std::vector<Block>> blocks(set.sequences.size());
    for (std::size_t s = 0; s < set.sequences.size(); ++s)
        readers.emplace_back(set, s, options, bytes);
    tbb::parallel_for(std::size_t{0}, readers.size(), [&](std::size_t s) {
        if (s >= options.locked.size() || !options.locked[s])
            blocks[s] = poolSteps(readers[s], options.ordering);
    });
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
    std::uint64_t triangles = 0;
    std::size_t total = 1;
    for (std::uint32_t s = 0; s < readers.size(); ++s) {
        triangles += readers[s].trianglesAfter(0);
        for (const Block& block : blocks[s])
            total += block.steps;
        if (!blocks[s].empty())
            heads.push({blocks[s].front().key(), s});
    }
    triangles_.reserve(total);
    error_.reserve(total);
    triangles_.push_back(triangles);
    error_.push_back(0.0f);
    std::vector<std::size_t> next(readers.size(), 0);
    double error = 0.0;
    while (!heads.empty()) {
        const std::uint32_t s = heads.top().submesh;
        heads.pop();
        const std::vector<Block>& queue = blocks[s];
        auto step = static_cast<std::uint32_t>(positions_[s].size());
        std::uint64_t before = readers[s].trianglesAfter(step);
        const auto head = [&] { return Head{queue[next[s]].key(), s}; };
        do { // as long as it is the cheapest
            for (std::uint32_t k = queue[next[s]++].steps; k > 0; --k, ++step) {
                const std::uint64_t after = readers[s].trianglesAfter(step + 1);
                triangles -= before - after;
                before = after;
                error = std::max(error, readers[s].errorOf(step, set.max_stretch[s]));
                positions_[s].push_back(static_cast<std::uint32_t>(triangles_.size()));
                triangles_.push_back(triangles);
                error_.push_back(static_cast<float>(100.0 * error / set.diagonal));
            }
        } while (next[s] < queue.size() && (heads.empty() || heads.top() > head()));
        if (next[s] < queue.size())
            heads.push(head());
    }
}

SubmeshState Schedule::stateAt(std::size_t submesh, std::uint64_t position) const {
    const std::vector<std::uint32_t>& at = positions_[submesh];
    const auto done =
        static_cast<std::uint32_t>(std::ranges::upper_bound(at, position) - at.begin());
    const std::uint32_t instances = set_->ranges[submesh].size();
    const std::uint32_t collapses = instances > 0 ? set_->sequences[submesh].step_count : 0;
    const std::uint32_t step = std::min(done, collapses);
    return {step, instances - (done - step)};
}

} // namespace lodestone
