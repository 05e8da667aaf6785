#include "simplify/collapse/schedule.h"

#include <algorithm>
#include <optional>
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
};

class StepReader {
public:
    StepReader(const SequenceSet& set,
               std::size_t submesh,
               const ScheduleOptions& options,
               const ByteModel* bytes)
        : sequence_(set.sequences[submesh]), removal_(set.removals[submesh]),
          instances_(set.ranges[submesh].size()), stretch_(set.max_stretch[submesh]),
          ordering_(options.ordering) {
        if (submesh < options.importance.size())
            importance_ = options.importance[submesh];
        if (ordering_ != Ordering::Byte)
            return;
        const auto s = static_cast<std::uint32_t>(submesh);
        for (std::uint32_t p = 0; p < sequence_.counts.size(); ++p)
            rates_.push_back({bytes->bytesPerVertex(s, p), bytes->bytesPerTriangle(s, p)});
        bytes_per_instance_ = bytes->bytesPerInstance(s);
    }

    std::uint32_t instances() const { return instances_; }

    std::uint32_t collapses() const { return instances_ > 0 ? sequence_.step_count : 0; }

    std::uint32_t removals() const { return static_cast<std::uint32_t>(removal_.cost.size()); }

    // Step numbers start at 0 here: collapse i leads from step i to step i + 1. With all instances.
    Block collapse(std::uint32_t i) const {
        return {importance_ * sequence_.cost[i], collapseGain(i), 1};
    }

    // By how much more a collapse costs for what it gains once instances are gone: the errors of
    // the survivors grow as they do.
    double dearness(std::uint32_t removed) const {
        if (removed == 0)
            return 1.0;
        const double growth = removal_.growth[removed - 1];
        const double cost = growth * growth * growth * growth;
        return ordering_ == Ordering::Triangle ? cost : cost * (instances_ - removed) / instances_;
    }

    // Of the removal after that many others, at a step of the collapses.
    Block removal(SubmeshState state) const {
        const std::uint32_t removed = instances_ - state.kept_instances;
        double gain = 1.0;
        if (ordering_ == Ordering::Triangle)
            gain = sequence_.facesAt(state.step);
        else if (ordering_ == Ordering::Byte)
            gain = bytes_per_instance_;
        return {importance_ * removal_.cost[removed], gain, 1};
    }

    std::uint64_t trianglesAt(SubmeshState state) const {
        return std::uint64_t{sequence_.facesAt(state.step)} * state.kept_instances;
    }

    double collapseError(std::uint32_t i) const {
        return static_cast<double>(sequence_.error[i]) * stretch_;
    }

    double removalError(std::uint32_t removed) const {
        return static_cast<double>(removal_.error[removed]);
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

    const CollapseSequence& sequence_;
    const RemovalSequence& removal_;
    std::uint32_t instances_;
    double stretch_;
    Ordering ordering_;
    double importance_ = 1.0;
    std::vector<Rates> rates_; // [primitives]
    double bytes_per_instance_ = 0.0;
};

// Pools adjacent violators: blocks of rising cost per gain. A cheap run behind one dear step, or a
// step that gains nothing (a vertex without faces), joins its neighbours.
// By cost alone nothing is averaged: a step waits for the dearest one before it (one global queue).
std::vector<Block> poolCollapses(const StepReader& reader, Ordering ordering) {
    std::vector<Block> blocks;
    for (std::uint32_t i = 0; i < reader.collapses(); ++i) {
        Block block = reader.collapse(i);
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

// The steps of one submesh in their order: whichever is cheaper of its next collapses and its next
// removal. Either makes the other dearer: fewer triangles go with an instance, errors grow with the
// survivors.
class Steps {
public:
    Steps(const StepReader& reader, Ordering ordering)
        : reader_(reader), ordering_(ordering),
          blocks_(poolCollapses(reader, ordering)), state_{0, reader.instances()} {
        chooseNext();
    }

    bool done() const { return !collapse_next_ && !removal_next_; }

    double key() const { return key_; }

    bool nextIsCollapse() const { return collapse_next_; }

    // Of the collapses that come together.
    std::uint32_t nextCount() const { return collapse_next_ ? blocks_[next_].steps : 1; }

    SubmeshState state() const { return state_; }

    // Takes one of nextCount() steps; after the last chooses anew.
    void take() {
        if (!collapse_next_) {
            --state_.kept_instances;
            chooseNext();
            return;
        }
        ++state_.step;
        if (++taken_ < blocks_[next_].steps)
            return;
        taken_ = 0;
        ++next_;
        chooseNext();
    }

private:
    void chooseNext() {
        const std::uint32_t removed = reader_.instances() - state_.kept_instances;
        collapse_next_ = next_ < blocks_.size();
        removal_next_ = removed < reader_.removals();
        // By cost as the paper has it: instances go when nothing is left to collapse.
        if (collapse_next_ && removal_next_ && ordering_ == Ordering::Cost)
            removal_next_ = false;
        const double collapse =
            collapse_next_ ? blocks_[next_].key() * reader_.dearness(removed) : 0.0;
        const double removal = removal_next_ ? reader_.removal(state_).key() : 0.0;
        if (collapse_next_ && removal_next_)
            (removal < collapse ? collapse_next_ : removal_next_) = false;
        key_ = std::max(key_, collapse_next_ ? collapse : removal);
    }

    const StepReader& reader_;
    Ordering ordering_;
    std::vector<Block> blocks_;
    std::size_t next_ = 0;
    std::uint32_t taken_ = 0; // of blocks_[next_]
    SubmeshState state_;
    bool collapse_next_ = false;
    bool removal_next_ = false;
    double key_ = 0.0;
};

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
    for (std::size_t s = 0; s < set.sequences.size(); ++s)
        readers.emplace_back(set, s, options, bytes);
    std::vector<std::optional<Steps>> steps(readers.size());
    tbb::parallel_for(std::size_t{0}, readers.size(), [&](std::size_t s) {
        if (s >= options.locked.size() || !options.locked[s])
            steps[s].emplace(readers[s], options.ordering);
    });
    std::priority_queue<Head, std::vector<Head>, std::greater<>> heads;
    std::uint64_t triangles = 0;
    std::size_t total = 1;
    for (std::uint32_t s = 0; s < readers.size(); ++s) {
        triangles += readers[s].trianglesAt({0, readers[s].instances()});
        if (!steps[s] || steps[s]->done())
            continue;
        total += readers[s].collapses() + readers[s].removals();
        heads.push({steps[s]->key(), s});
    }
    triangles_.reserve(total);
    error_.reserve(total);
    triangles_.push_back(triangles);
    error_.push_back(0.0f);
    double error = 0.0;
    while (!heads.empty()) {
        const std::uint32_t s = heads.top().submesh;
        heads.pop();
        Steps& of = *steps[s];
        const bool collapse = of.nextIsCollapse();
        std::vector<std::uint32_t>& positions =
            collapse ? positions_[s].collapses : positions_[s].removals;
        for (std::uint32_t left = of.nextCount(); left > 0; --left) {
            const SubmeshState before = of.state();
            of.take();
            triangles -= readers[s].trianglesAt(before) - readers[s].trianglesAt(of.state());
            error = std::max(
                error,
                collapse ? readers[s].collapseError(before.step)
                         : readers[s].removalError(readers[s].instances() - before.kept_instances));
            positions.push_back(static_cast<std::uint32_t>(triangles_.size()));
            triangles_.push_back(triangles);
            error_.push_back(static_cast<float>(100.0 * error / set.diagonal));
        }
        if (!of.done())
            heads.push({of.key(), s});
    }
}

SubmeshState Schedule::stateAt(std::size_t submesh, std::uint64_t position) const {
    const auto done = [&](const std::vector<std::uint32_t>& at) {
        return static_cast<std::uint32_t>(std::ranges::upper_bound(at, position) - at.begin());
    };
    const StepPositions& positions = positions_[submesh];
    return {done(positions.collapses), set_->ranges[submesh].size() - done(positions.removals)};
}

} // namespace lodestone
