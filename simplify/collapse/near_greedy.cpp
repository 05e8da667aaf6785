#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <bit>
#include <functional>
#include <numeric>

namespace lodestone {

namespace {

// Costs in bands an eighth of an octave wide: the exponent and three bits of the mantissa. Inside a
// band, edges keep the order they are stored in, which is roughly the mesh's: edges that cost
// nearly the same are taken where memory is warm.
constexpr int kBandShift = 20;
constexpr std::uint32_t kBands = 1u << (32 - kBandShift);

std::uint32_t bandOf(float cost) {
    return std::bit_cast<std::uint32_t>(cost) >> kBandShift;
}

// A pass goes through a mesh that no cache holds tile by tile, vertices with neighbouring numbers,
// and by rising cost in each. Its steps are then put in the order of their costs.
constexpr std::size_t kTiledAbove = 65'536; // vertices
constexpr std::uint32_t kTileVertices = 8192;

struct Edge {
    float cost = 0.0f; // >= 0
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

class PassQueue {
public:
    explicit PassQueue(ComponentMesh& mesh)
        : mesh_(mesh), touched_(mesh.vertexCount(), false), bands_(mesh.vertexCount(), 0) {
        for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
            addAround(v, [&](std::uint32_t other) { return other > v; });
    }

    // One pass. The number of collapses, or -1 if stopped.
    std::int64_t run(std::uint32_t stop_at_faces, const CollapseWatch& watch) {
        std::uint32_t live = mesh_.liveFaces();
        const std::uint32_t first_step = mesh_.stepCount();
        selectCheapest();
        moved_.clear();
        step_bands_.clear();
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
            if (tiled())
                step_bands_.push_back(bandAfterNeighbors(bandOf(cost)));
        }
        if (tiled())
            mesh_.reorderSteps(first_step, stepsByBand());
        refresh();
        return watch.goOn(mesh_, live) ? static_cast<std::int64_t>(moved_.size()) : -1;
    }

private:
    bool tiled() const { return touched_.size() > kTiledAbove; }

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

    // The band of the collapse that has just been made, but none before those of collapses made
    // earlier in the pass that it builds on.
    std::uint32_t bandAfterNeighbors(std::uint32_t band) {
        mesh_.visitReadByCollapse([&](std::uint32_t v) { band = std::max(band, bands_[v]); });
        mesh_.visitChangedByCollapse([&](std::uint32_t v) { bands_[v] = band; });
        return band;
    }

    static std::uint32_t bandOfEdge(const Edge& edge) { return bandOf(edge.cost); }

    // [bands] How many come before a band.
    template <class Values, class BandOf>
    std::vector<std::uint32_t>& countBands(const Values& values, BandOf band_of) {
        counts_.assign(kBands + 1, 0);
        for (const auto& value : values)
            ++counts_[band_of(value) + 1];
        std::partial_sum(counts_.begin(), counts_.end(), counts_.begin());
        return counts_;
    }

    // Indices of the pass's collapses by rising band (counting sort, stable).
    std::span<const std::uint32_t> stepsByBand() {
        std::vector<std::uint32_t>& begin = countBands(step_bands_, std::identity{});
        step_order_.resize(step_bands_.size());
        for (std::uint32_t i = 0; i < step_bands_.size(); ++i)
            step_order_[begin[step_bands_[i]]++] = i;
        return step_order_;
    }

    // The last band to take: that of 1.5 x the cost of the edge at which a quarter of the faces
    // would be gone.
    std::uint32_t lastBand() {
        const std::size_t goal = std::min<std::size_t>(edges_.size() - 1, mesh_.liveFaces() / 8);
        const std::vector<std::uint32_t>& before = countBands(edges_, bandOfEdge);
        // The band of the edge at `goal`.
        const auto after = std::ranges::upper_bound(before, goal);
        const auto middle = static_cast<std::uint32_t>(after - before.begin()) - 1;
        const auto cost = std::bit_cast<float>(middle << kBandShift);
        return std::min(bandOf(1.5f * cost), kBands - 1);
    }

    // Edges up to the last band, by tile, then by band (counting sorts, stable).
    void selectCheapest() {
        const std::uint32_t last = lastBand();
        const auto tile_of = [&](std::size_t vertex) {
            return tiled() ? vertex / kTileVertices : 0;
        };
        std::vector<std::uint32_t> begin(tile_of(touched_.size()) + 2, 0);
        for (const Edge& edge : edges_)
            begin[tile_of(edge.a) + 1] += static_cast<std::uint32_t>(bandOf(edge.cost) <= last);
        std::partial_sum(begin.begin(), begin.end(), begin.begin());
        chosen_.resize(begin.back());
        std::vector<std::uint32_t> at(begin.begin(), begin.end() - 1);
        for (const Edge& edge : edges_)
            if (bandOf(edge.cost) <= last)
                chosen_[at[tile_of(edge.a)]++] = edge;
        for (std::size_t tile = 0; tile + 1 < begin.size(); ++tile)
            sortByBand(std::span(chosen_).subspan(begin[tile], begin[tile + 1] - begin[tile]));
    }

    void sortByBand(std::span<Edge> edges) {
        unsorted_.assign(edges.begin(), edges.end());
        std::vector<std::uint32_t>& begin = countBands(unsorted_, bandOfEdge);
        for (const Edge& edge : unsorted_)
            edges[begin[bandOf(edge.cost)]++] = edge;
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
        bands_.assign(bands_.size(), 0);
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
        bands_.resize(mesh_.vertexCount());
    }

    ComponentMesh& mesh_;
    std::vector<Edge> edges_;
    std::vector<Edge> chosen_;         // of the pass, in the order they are tried
    std::vector<std::uint32_t> moved_; // survivors of the pass
    std::vector<char> touched_;        // [vertices] took part in the pass
    std::vector<std::uint32_t> bands_; // [vertices] of the pass's last collapse that changed them
    std::vector<std::uint32_t> step_bands_; // [collapses of the pass]
    std::vector<std::uint32_t> step_order_;
    std::vector<std::uint32_t> counts_; // scratch
    std::vector<Edge> unsorted_;        // scratch
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
