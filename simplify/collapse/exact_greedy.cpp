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
            if (mesh_.alive(v))
                mesh_.forNeighbours(v, [&](std::uint32_t other) {
                    if (other > v)
                        heap_.push_back(candidate(v, other));
                });
        std::ranges::make_heap(heap_, Later{});
    }

    void pushAround(std::uint32_t v) {
        mesh_.forNeighbours(v, [&](std::uint32_t other) {
            heap_.push_back(candidate(std::min(v, other), std::max(v, other)));
            std::ranges::push_heap(heap_, Later{});
        });
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

    Candidate candidate(std::uint32_t a, std::uint32_t b) const {
        const float key = mesh_.place(a, b).key;
        return {std::uint64_t{std::bit_cast<std::uint32_t>(key)} << 32 | a, b, stampOf(a, b)};
    }

    ComponentMesh& mesh_;
    std::vector<Candidate> heap_;
};

// Runs one queue until it is empty. Sets `moved` if anything collapsed. False if stopped.
bool drain(ComponentMesh& mesh,
           LazyHeap& heap,
           Strictness strictness,
           const JobContext& job,
           bool& moved) {
    Candidate candidate;
    for (std::uint32_t round = 1; heap.pop(candidate); ++round) {
        if (round % 1024 == 0 && job.stopRequested())
            return false;
        const std::uint32_t a = candidate.first();
        const std::uint32_t b = candidate.second;
        if (!mesh.movable(a, b) || !mesh.tryCollapse(a, b, mesh.place(a, b), strictness))
            continue;
        moved = true;
        heap.pushAround(a);
    }
    return !job.stopRequested();
}

} // namespace

bool collapseExactGreedy(ComponentMesh& mesh, const JobContext& job) {
    LazyHeap heap(mesh);
    // A rejected edge may become possible once its surroundings have changed: queues are refilled
    // while that helps, and only then is the next liberty taken.
    for (const Strictness strictness :
         {Strictness::Manifold, Strictness::Upright, Strictness::Anything}) {
        bool moved = true;
        while (moved && mesh.liveFaces() > 0) {
            moved = false;
            heap.fill();
            if (!drain(mesh, heap, strictness, job, moved))
                return false;
        }
    }
    return true;
}

} // namespace lodestone
