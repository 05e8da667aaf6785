#include "simplify/collapse/component_mesh.h"
#include "simplify/collapse/key_heap.h"

#include <algorithm>
#include <bit>
#include <vector>

namespace lodestone {

namespace {

// A candidate edge, a < b.
struct Candidate {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t stamp = 0; // sum of both ends' versions when it was costed
};

// Candidates by cost, then by slot: in the order they were costed until slots are used again, the
// same everywhere.
class LazyHeap {
public:
    explicit LazyHeap(ComponentMesh& mesh) : mesh_(mesh) {}

    void fill() {
        heap_.clear();
        slots_.clear();
        free_slots_.clear();
        for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
            addAround(
                v,
                [&](std::uint32_t other) { return other > v; },
                [&](std::uint64_t key) { heap_.append(key); });
        heap_.arrange();
    }

    void pushAround(std::uint32_t v) {
        addAround(
            v, [](std::uint32_t) { return true; }, [&](std::uint64_t key) { heap_.push(key); });
    }

    // The cheapest candidate whose ends have not changed since; false if there is none.
    bool pop(Candidate& out) {
        while (!heap_.empty()) {
            const auto slot = static_cast<std::uint32_t>(heap_.pop());
            out = slots_[slot];
            free_slots_.push_back(slot);
            if (out.stamp == stampOf(out.a, out.b))
                return true;
        }
        return false;
    }

private:
    std::uint32_t stampOf(std::uint32_t a, std::uint32_t b) const {
        return mesh_.version(a) + mesh_.version(b);
    }

    std::uint32_t store(const Candidate& candidate) {
        if (free_slots_.empty()) {
            slots_.push_back(candidate);
            return static_cast<std::uint32_t>(slots_.size() - 1);
        }
        const std::uint32_t slot = free_slots_.back();
        free_slots_.pop_back();
        slots_[slot] = candidate;
        return slot;
    }

    template <class Accept, class Push>
    void addAround(std::uint32_t v, Accept accept, Push push) {
        const ComponentMesh::Spokes spokes = mesh_.costSpokes(v, accept);
        for (std::size_t i = 0; i < spokes.others.size(); ++i) {
            const std::uint32_t a = std::min(v, spokes.others[i]);
            const std::uint32_t b = std::max(v, spokes.others[i]);
            const auto cost = std::bit_cast<std::uint32_t>(spokes.keys[i]);
            push(std::uint64_t{cost} << 32 | store({a, b, stampOf(a, b)}));
        }
    }

    ComponentMesh& mesh_;
    KeyHeap heap_;                          // cost, then slot
    std::vector<Candidate> slots_;          // [slots]
    std::vector<std::uint32_t> free_slots_; // the last freed is used first
};

// Runs one queue until it is empty. Sets `moved` if anything collapsed. False if stopped.
bool drain(ComponentMesh& mesh,
           LazyHeap& heap,
           Strictness strictness,
           const CollapseWatch& watch,
           bool& moved) {
    Candidate candidate;
    std::uint32_t live = mesh.liveFaces();
    for (std::uint32_t round = 1; heap.pop(candidate); ++round) {
        if (round % 1024 == 0 && !watch.goOn(mesh, live))
            return false;
        const auto [a, b, stamp] = candidate;
        if (!mesh.movable(a, b) || !mesh.tryCollapse(a, b, mesh.place(a, b), strictness))
            continue;
        moved = true;
        heap.pushAround(a);
    }
    return watch.goOn(mesh, live);
}

} // namespace

bool collapseExactGreedy(ComponentMesh& mesh, const CollapseWatch& watch) {
    LazyHeap heap(mesh);
    // A rejected edge may become possible once its surroundings have changed: queues are refilled
    // while that helps, and only then is the next liberty taken.
    for (const Strictness strictness :
         {Strictness::Manifold, Strictness::Upright, Strictness::Anything}) {
        bool moved = true;
        while (moved && mesh.liveFaces() > 0) {
            moved = false;
            heap.fill();
            if (!drain(mesh, heap, strictness, watch, moved))
                return false;
        }
    }
    return true;
}

} // namespace lodestone
