#include "simplify/wild/wild_mesh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace lodestone {

namespace {

struct Pair {
    float key = 0.0f;
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t stamp = 0; // sum of both ends' versions when it was costed
};

struct Later {
    bool operator()(const Pair& x, const Pair& y) const {
        return x.key > y.key || (x.key == y.key && (x.a > y.a || (x.a == y.a && x.b > y.b)));
    }
};

// The 1-simplices of the complex: none is ever added, collapses only rename their ends.
class PairQueue {
public:
    explicit PairQueue(WildMesh& mesh) : mesh_(mesh), merged_into_(mesh.vertexCount()) {
        std::iota(merged_into_.begin(), merged_into_.end(), 0u);
        for (const auto& [a, b] : mesh.edges())
            if (mesh.movable(a, b))
                heap_.push_back(costed(a, b));
        std::ranges::make_heap(heap_, Later{});
    }

    // Collapses until the queue is empty. False if stopped. Sets `moved` if anything collapsed.
    bool drain(Strictness strictness, const CollapseWatch& watch, bool& moved) {
        std::uint32_t live = mesh_.liveFaces();
        Pair pair;
        for (std::uint32_t round = 1; pop(pair); ++round) {
            if (round % 256 == 0 && !watch.goOn(mesh_, live))
                return false;
            if (mesh_.valence(pair.a) < mesh_.valence(pair.b))
                std::swap(pair.a, pair.b);
            if (mesh_.collapse(pair.a, pair.b, strictness)) {
                merged_into_[pair.b] = pair.a;
                moved = true;
            } else {
                rejected_.push_back(pair);
            }
        }
        return watch.goOn(mesh_, live);
    }

    // Offers what was rejected once more: its surroundings may have changed.
    void refill() {
        for (const Pair& pair : rejected_)
            push(pair.a, pair.b);
        rejected_.clear();
    }

private:
    std::uint32_t standIn(std::uint32_t v) {
        while (merged_into_[v] != v)
            v = merged_into_[v] = merged_into_[merged_into_[v]];
        return v;
    }

    std::uint32_t stampOf(std::uint32_t a, std::uint32_t b) const {
        return mesh_.version(a) + mesh_.version(b);
    }

    Pair costed(std::uint32_t a, std::uint32_t b) {
        return {mesh_.key(a, b), std::min(a, b), std::max(a, b), stampOf(a, b)};
    }

    void push(std::uint32_t a, std::uint32_t b) {
        a = standIn(a);
        b = standIn(b);
        if (a == b || !mesh_.alive(a) || !mesh_.alive(b))
            return;
        heap_.push_back(costed(a, b));
        std::ranges::push_heap(heap_, Later{});
    }

    // The cheapest pair, as far as costs are known. False if there is none.
    bool pop(Pair& out) {
        while (!heap_.empty()) {
            std::ranges::pop_heap(heap_, Later{});
            out = heap_.back();
            heap_.pop_back();
            const std::uint32_t a = standIn(out.a);
            const std::uint32_t b = standIn(out.b);
            if (a == b || !mesh_.alive(a) || !mesh_.alive(b))
                continue;
            if (a == out.a && b == out.b && out.stamp == stampOf(a, b))
                return true;
            push(a, b);
        }
        return false;
    }

    WildMesh& mesh_;
    std::vector<std::uint32_t> merged_into_; // [vertices] itself if alive
    std::vector<Pair> heap_;
    std::vector<Pair> rejected_;
};

} // namespace

bool collapseLazily(WildMesh& mesh, Strictness first, const CollapseWatch& watch) {
    PairQueue queue(mesh);
    for (const Strictness strictness :
         {Strictness::Manifold, Strictness::Upright, Strictness::Anything}) {
        if (strictness < first)
            continue;
        bool moved = true;
        while (moved && mesh.liveFaces() > 0) {
            moved = false;
            if (!queue.drain(strictness, watch, moved))
                return false;
            queue.refill();
        }
    }
    return true;
}

} // namespace lodestone
