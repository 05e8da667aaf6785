#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <bit>

namespace lodestone {

namespace {

// A candidate edge. Orders by cost, then by vertex, so that ties fall the same way everywhere.
struct Candidate {
    std::uint64_t key = 0; // bits of the cost, then the first vertex
    std::uint32_t second = 0;
    std::uint32_t stamp = 0; // sum of both ends' versions when it was costed

    std::uint32_t first() const { return static_cast<std::uint32_t>(key); }
};

struct Later {
    bool operator()(const Candidate& a, const Candidate& b) const {
        return a.key > b.key || (a.key == b.key && a.second > b.second);
    }
};

class LazyHeap {
public:
    explicit LazyHeap(ComponentMesh& mesh) : mesh_(mesh) {}

    void fill() {
        heap_.clear();
        for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
            addAround(v, [&](std::uint32_t other) { return other > v; });
        std::ranges::make_heap(heap_, Later{});
    }

    void pushAround(std::uint32_t v) {
        const std::size_t before = heap_.size();
        addAround(v, [](std::uint32_t) { return true; });
        for (std::size_t end = before + 1; end <= heap_.size(); ++end)
            std::ranges::push_heap(
                heap_.begin(), heap_.begin() + static_cast<std::ptrdiff_t>(end), Later{});
    }

    // The cheapest candidate whose ends have not changed since; false if there is none.
    bool pop(Candidate& out) {
        while (!heap_.empty()) {
            std::ranges::pop_heap(heap_, Later{});
            out = heap_.back();
            heap_.pop_back();
            if (out.stamp == stampOf(out.first(), out.second))
                return true;
        }
        return false;
    }

private:
    std::uint32_t stampOf(std::uint32_t a, std::uint32_t b) const {
        return mesh_.version(a) + mesh_.version(b);
    }

    template <class Accept>
    void addAround(std::uint32_t v, Accept accept) {
        const ComponentMesh::Spokes spokes = mesh_.costSpokes(v, accept);
        for (std::size_t i = 0; i < spokes.others.size(); ++i) {
            const std::uint32_t a = std::min(v, spokes.others[i]);
            const std::uint32_t b = std::max(v, spokes.others[i]);
            const auto cost = std::bit_cast<std::uint32_t>(spokes.keys[i]);
            heap_.push_back({std::uint64_t{cost} << 32 | a, b, stampOf(a, b)});
        }
    }

    ComponentMesh& mesh_;
    std::vector<Candidate> heap_;
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
        const std::uint32_t a = candidate.first();
        const std::uint32_t b = candidate.second;
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
