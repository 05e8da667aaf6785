#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <array>
#include <bit>

namespace lodestone {

namespace {

// Costs in bands an eighth of an octave wide: the exponent and three bits of the mantissa. Inside a
// band, edges keep the order they are stored in, which is roughly the mesh's: edges that cost
// nearly the same are taken where memory is warm (a third faster on a million faces, same error).
constexpr int kBandShift = 20;
constexpr std::size_t kBands = std::size_t{1} << (32 - kBandShift);

std::size_t bandOf(float cost) {
    return std::bit_cast<std::uint32_t>(cost) >> kBandShift;
}

struct Edge {
    float cost = 0.0f; // >= 0
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

class PassQueue {
public:
    explicit PassQueue(ComponentMesh& mesh) : mesh_(mesh), touched_(mesh.vertexCount(), false) {
        for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
            addAround(v, [&](std::uint32_t other) { return other > v; });
    }

    // One pass. The number of collapses, or -1 if stopped.
    std::int64_t run(std::uint32_t stop_at_faces, const CollapseWatch& watch) {
        std::uint32_t live = mesh_.liveFaces();
        selectCheapest();
        std::int64_t collapses = 0;
        moved_.clear();
        for (std::size_t i = 0; i < chosen_.size() && mesh_.liveFaces() > stop_at_faces; ++i) {
            if (i % 1024 == 0 && !watch.goOn(mesh_, live))
                return -1;
            prefetchAhead(i, chosen_.size(), [&](std::size_t at, auto prefetch) {
                const auto [cost, a, b] = chosen_[at];
                if (touched_[a] | touched_[b])
                    return;
                prefetch(a);
                prefetch(b);
            });
            const auto [cost, a, b] = chosen_[i];
            if ((touched_[a] | touched_[b]) || !mesh_.movable(a, b) ||
                !mesh_.tryCollapse(a, b, mesh_.place(a, b), Strictness::Manifold))
                continue;
            touched_[a] = touched_[b] = true;
            moved_.push_back(a);
            ++collapses;
        }
        refresh();
        return watch.goOn(mesh_, live) ? collapses : -1;
    }

private:
    template <class Accept>
    void addAround(std::uint32_t v, Accept accept) {
        const ComponentMesh::Spokes spokes = mesh_.costSpokes(v, accept);
        for (std::size_t i = 0; i < spokes.others.size(); ++i) {
            const std::uint32_t other = spokes.others[i];
            edges_.push_back({spokes.keys[i], std::min(v, other), std::max(v, other)});
        }
    }

    // What is looked at next is known, so its memory can be on its way.
    template <class Ids>
    void prefetchAhead(std::size_t i, std::size_t count, Ids ids) const {
        constexpr std::size_t kFar = 48, kMiddle = 32, kNear = 16;
        if (i + kFar < count)
            ids(i + kFar, [&](std::uint32_t v) { mesh_.prefetchRing(v); });
        if (i + kMiddle < count)
            ids(i + kMiddle, [&](std::uint32_t v) { mesh_.prefetchReferences(v); });
        if (i + kNear < count)
            ids(i + kNear, [&](std::uint32_t v) { mesh_.prefetchFaces(v); });
    }

    // Edges up to 1.5 x the cost of the one at which a quarter of the faces would be gone, sorted
    // by band (counting sort, stable).
    void selectCheapest() {
        const std::size_t goal = std::min<std::size_t>(edges_.size() - 1, mesh_.liveFaces() / 8);
        std::array<std::size_t, kBands + 1> begin{};
        for (const Edge& edge : edges_)
            ++begin[bandOf(edge.cost) + 1];
        std::size_t middle = 0; // the band of the edge at `goal`
        for (std::size_t band = 0; band < kBands; ++band) {
            if (begin[band] <= goal)
                middle = band;
            begin[band + 1] += begin[band];
        }
        const auto cost = std::bit_cast<float>(static_cast<std::uint32_t>(middle << kBandShift));
        const std::size_t last = std::min(bandOf(1.5f * cost), kBands - 1);
        chosen_.resize(begin[last + 1]);
        for (const Edge& edge : edges_)
            if (bandOf(edge.cost) <= last)
                chosen_[begin[bandOf(edge.cost)]++] = edge;
    }

    // Edges with an end that changed are costed anew; all others are still exact.
    void refresh() {
        std::ranges::sort(moved_); // walked in memory order
        std::size_t kept = 0;
        for (const Edge& edge : edges_) { // no branch: a good part of them goes
            edges_[kept] = edge;
            kept += static_cast<std::size_t>((touched_[edge.a] | touched_[edge.b]) == 0);
        }
        edges_.resize(kept);
        for (std::size_t i = 0; i < moved_.size(); ++i) {
            prefetchAhead(
                i, moved_.size(), [&](std::size_t at, auto prefetch) { prefetch(moved_[at]); });
            const std::uint32_t v = moved_[i];
            addAround(v, [&](std::uint32_t other) { return !touched_[other] || other > v; });
        }
        touched_.assign(touched_.size(), false);
        renumber(mesh_.compact());
    }

    void renumber(std::span<const std::uint32_t> moved_to) {
        if (moved_to.empty())
            return;
        for (Edge& edge : edges_) {
            edge.a = moved_to[edge.a];
            edge.b = moved_to[edge.b];
        }
        touched_.resize(mesh_.vertexCount());
    }

    ComponentMesh& mesh_;
    std::vector<Edge> edges_;
    std::vector<Edge> chosen_;
    std::vector<std::uint32_t> moved_; // survivors of the pass
    std::vector<char> touched_;        // [vertices] took part in the pass
};

} // namespace

bool collapseNearGreedy(ComponentMesh& mesh,
                        std::uint32_t stop_at_faces,
                        const CollapseWatch& watch) {
    PassQueue queue(mesh);
    while (mesh.liveFaces() > stop_at_faces) {
        const std::uint32_t before = mesh.liveFaces();
        const std::int64_t collapses = queue.run(stop_at_faces, watch);
        if (collapses < 0)
            return false;
        if (mesh.liveFaces() > before - before / 50) // the heap gets farther
            break;
    }
    return true;
}

} // namespace lodestone
