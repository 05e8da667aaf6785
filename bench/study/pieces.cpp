#include "bench/study/pieces.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace lodestone::bench {

namespace {

class PieceCounter {
public:
    // The vertices of a further primitive of the submesh.
    void add(const Geometry& geometry) {
        const auto first = static_cast<std::uint32_t>(places_.size());
        places_.insert(places_.end(), geometry.positions.begin(), geometry.positions.end());
        for (const std::uint32_t index : geometry.indices)
            corners_.push_back(first + index);
    }

    std::uint64_t count() {
        parents_.resize(places_.size());
        std::iota(parents_.begin(), parents_.end(), 0U);
        joinEqualPlaces();
        for (std::size_t t = 0; t + 2 < corners_.size(); t += 3) {
            join(corners_[t], corners_[t + 1]);
            join(corners_[t], corners_[t + 2]);
        }
        std::vector<std::uint32_t> roots;
        for (const std::uint32_t corner : corners_)
            roots.push_back(rootOf(corner));
        std::ranges::sort(roots);
        return static_cast<std::uint64_t>(std::unique(roots.begin(), roots.end()) - roots.begin());
    }

private:
    static auto keyOf(const glm::vec3& at) { return std::tuple(at.x, at.y, at.z); }

    void joinEqualPlaces() {
        std::vector<std::uint32_t> order(places_.size());
        std::iota(order.begin(), order.end(), 0U);
        std::ranges::sort(order, {}, [&](std::uint32_t v) { return keyOf(places_[v]); });
        for (std::size_t i = 1; i < order.size(); ++i)
            if (places_[order[i]] == places_[order[i - 1]])
                join(order[i], order[i - 1]);
    }

    std::uint32_t rootOf(std::uint32_t v) {
        while (parents_[v] != v)
            v = parents_[v] = parents_[parents_[v]];
        return v;
    }

    void join(std::uint32_t a, std::uint32_t b) { parents_[rootOf(a)] = rootOf(b); }

    std::vector<glm::vec3> places_;
    std::vector<std::uint32_t> corners_;
    std::vector<std::uint32_t> parents_;
};

} // namespace

std::uint64_t countPieces(const Scene& scene, const Lod& lod) {
    std::uint64_t pieces = 0;
    for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
        PieceCounter counter;
        for (std::size_t p = 0; p < lod.submeshes[s].primitives.size(); ++p)
            if (scene.submeshes[s].primitives[p].mode == PrimitiveMode::Triangles)
                counter.add(*lod.submeshes[s].primitives[p]);
        pieces += counter.count() * lod.submeshes[s].kept_instances;
    }
    return pieces;
}

} // namespace lodestone::bench
