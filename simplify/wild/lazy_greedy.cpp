#include "simplify/collapse/key_heap.h"
#include "simplify/wild/wild_mesh.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>

namespace lodestone {

namespace {

// Follows a chain of stand-ins to its end and shortens it.
std::uint32_t standIn(std::vector<std::uint32_t>& stand_ins, std::uint32_t at) {
    while (stand_ins[at] != at)
        at = stand_ins[at] = stand_ins[stand_ins[at]];
    return at;
}

// The 1-simplices of the complex: none is ever added; collapses rename their ends and make some
// coincide.
class EdgeQueue {
public:
    explicit EdgeQueue(WildMesh& mesh)
        : mesh_(mesh), merged_into_(mesh.vertexCount()), ends_(mesh.edges()), stamps_(ends_.size()),
          keys_(ends_.size()), became_(ends_.size()), dropped_(ends_.size(), 0) {
        std::iota(merged_into_.begin(), merged_into_.end(), 0u);
        std::iota(became_.begin(), became_.end(), 0u);
        for (std::uint32_t e = 0; e < ends_.size(); ++e)
            if (mesh.movable(ends_[e][0], ends_[e][1]))
                cost(e);
            else
                drop(e);
    }

    // Passes until few faces are left: each costs what has changed, then takes edges by rising
    // cost, every vertex at most once, up to 1.5 x the cost at which a quarter of the faces would
    // be gone. False if stopped.
    bool runPasses(std::uint32_t stop_at_faces, Strictness strictness, const CollapseWatch& watch) {
        std::uint32_t live = mesh_.liveFaces();
        std::vector<std::uint64_t> chosen;
        std::vector<char> touched;
        while (mesh_.liveFaces() > stop_at_faces) {
            const std::uint32_t before = mesh_.liveFaces();
            chooseCheapest(chosen);
            touched.assign(mesh_.vertexCount(), 0);
            for (std::size_t i = 0; i < chosen.size() && mesh_.liveFaces() > stop_at_faces; ++i) {
                if (i % 256 == 0 && !watch.goOn(mesh_, live))
                    return false;
                const auto edge = static_cast<std::uint32_t>(chosen[i]);
                const auto [a, b] = ends_[edge];
                if ((touched[a] | touched[b]) || !mesh_.alive(a) || !mesh_.alive(b) ||
                    !collapse(edge, strictness))
                    continue;
                touched[a] = touched[b] = 1;
            }
            if (mesh_.liveFaces() > before - before / 50) // the heap gets farther
                break;
        }
        return watch.goOn(mesh_, live);
    }

    // After passes, before drain(): all edges into the queue.
    void fill() {
        for (std::uint32_t e = 0; e < ends_.size(); ++e)
            if (exists(e))
                heap_.append(entry(e));
        heap_.arrange();
    }

    // Collapses until the queue is empty. False if stopped. Sets `moved` if anything collapsed.
    bool drain(Strictness strictness, const CollapseWatch& watch, bool& moved) {
        std::uint32_t live = mesh_.liveFaces();
        std::uint32_t edge = 0;
        for (std::uint32_t round = 1; pop(edge); ++round) {
            if (round % 256 == 0 && !watch.goOn(mesh_, live))
                return false;
            if (collapse(edge, strictness))
                moved = true;
            else
                rejected_.push_back(edge);
        }
        return watch.goOn(mesh_, live);
    }

    // Offers what was rejected once more: its surroundings may have changed.
    void refill() {
        for (const std::uint32_t edge : rejected_)
            if (exists(edge) && refresh(edge)) {
                cost(edge);
                heap_.push(entry(edge));
            }
        rejected_.clear();
    }

private:
    static constexpr float kOut = std::numeric_limits<float>::infinity(); // not in the heap

    std::uint32_t stampOf(const WildMesh::Edge& ends) const {
        return mesh_.version(ends[0]) + mesh_.version(ends[1]);
    }

    bool exists(std::uint32_t edge) const { return became_[edge] == edge && !dropped_[edge]; }

    // It is no more, or never collapses.
    void drop(std::uint32_t edge) {
        dropped_[edge] = 1;
        keys_[edge] = kOut;
    }

    void cost(std::uint32_t edge) {
        const auto [a, b] = ends_[edge];
        keys_[edge] = mesh_.key(a, b);
        stamps_[edge] = stampOf(ends_[edge]);
    }

    std::uint64_t entry(std::uint32_t edge) const {
        return std::uint64_t{std::bit_cast<std::uint32_t>(keys_[edge])} << 32 | edge;
    }

    bool collapse(std::uint32_t edge, Strictness strictness) {
        auto [a, b] = ends_[edge];
        if (mesh_.valence(a) < mesh_.valence(b))
            std::swap(a, b);
        if (!mesh_.collapse(a, b, strictness))
            return false;
        merged_into_[b] = a;
        mesh_.visitCoinciding(a, b, [&](std::uint32_t x, std::uint32_t y) { unite(x, y); });
        return true;
    }

    // Brings an edge's ends up to date. False if it is no more.
    bool refresh(std::uint32_t edge) {
        auto& [a, b] = ends_[edge];
        a = standIn(merged_into_, a);
        b = standIn(merged_into_, b);
        return a != b && mesh_.alive(a) && mesh_.alive(b);
    }

    // Of two edges that coincide the one that comes up first stays.
    void unite(std::uint32_t x, std::uint32_t y) {
        x = standIn(became_, x);
        y = standIn(became_, y);
        if (keys_[y] < keys_[x])
            std::swap(x, y);
        became_[y] = x;
    }

    // Costs every edge that has changed; those for a pass, by rising cost.
    void chooseCheapest(std::vector<std::uint64_t>& chosen) {
        chosen.clear();
        for (std::uint32_t e = 0; e < ends_.size(); ++e) {
            if (!exists(e))
                continue;
            const WildMesh::Edge before = ends_[e];
            if (!refresh(e)) {
                drop(e);
                continue;
            }
            if (ends_[e] != before || stamps_[e] != stampOf(before))
                cost(e);
            chosen.push_back(entry(e));
        }
        if (chosen.empty())
            return;
        const std::size_t goal = std::min<std::size_t>(chosen.size() - 1, mesh_.liveFaces() / 8);
        const auto middle = chosen.begin() + static_cast<std::ptrdiff_t>(goal);
        std::ranges::nth_element(chosen, middle);
        const float limit = 1.5f * keys_[static_cast<std::uint32_t>(*middle)];
        std::erase_if(chosen, [&](std::uint64_t key) {
            return keys_[static_cast<std::uint32_t>(key)] > limit;
        });
        std::ranges::sort(chosen);
    }

    // The cheapest edge, as far as costs are known. False if there is none.
    bool pop(std::uint32_t& edge) {
        while (!heap_.empty()) {
            edge = static_cast<std::uint32_t>(heap_.top());
            const WildMesh::Edge before = ends_[edge];
            if (!exists(edge) || !refresh(edge)) {
                heap_.pop();
            } else if (ends_[edge] == before && stamps_[edge] == stampOf(before)) {
                heap_.pop();
                keys_[edge] = kOut;
                return true;
            } else {
                cost(edge);
                heap_.replaceTop(entry(edge));
            }
        }
        return false;
    }

    WildMesh& mesh_;
    std::vector<std::uint32_t> merged_into_; // [vertices] itself if alive
    std::vector<WildMesh::Edge> ends_;       // [edges] when last looked at
    std::vector<std::uint32_t> stamps_;      // [edges] sum of both ends' versions when costed
    std::vector<float> keys_;                // [edges] when costed
    std::vector<std::uint32_t> became_;      // [edges] itself unless it coincides with another
    std::vector<char> dropped_;              // [edges]
    KeyHeap heap_;                           // key, then edge
    std::vector<std::uint32_t> rejected_;
};

} // namespace

bool collapseLazily(WildMesh& mesh, const LazyGreedyOptions& options, const CollapseWatch& watch) {
    const Strictness first = options.first;
    EdgeQueue queue(mesh);
    if (mesh.liveFaces() > options.passes_above &&
        !queue.runPasses(options.passes_until, first, watch))
        return false;
    queue.fill();
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
