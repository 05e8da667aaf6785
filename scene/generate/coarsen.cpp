#include "scene/generate/implicit.h"

#include <algorithm>
#include <queue>

namespace lodestone::generate {

namespace {

class Coarsener {
public:
    Coarsener(Mesh& mesh, const Field& size)
        : mesh_(mesh), around_(mesh.positions.size()), version_(mesh.positions.size(), 0),
          size_(mesh.positions.size()) {
        for (std::uint32_t v = 0; v < size_.size(); ++v)
            size_[v] = size(mesh.positions[v]);
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = mesh.triangles[t][k];
                const std::uint32_t b = mesh.triangles[t][(k + 1) % 3];
                around_[a].push_back(t);
                if (a < b)
                    push(a, b);
            }
    }

    void run(std::size_t triangle_count) {
        alive_count_ = mesh_.triangles.size();
        while (alive_count_ > triangle_count && !queue_.empty()) {
            const Entry e = queue_.top();
            queue_.pop();
            if (version_[e.a] == e.version_a && version_[e.b] == e.version_b &&
                mayCollapse(e.a, e.b))
                collapse(e.a, e.b);
        }
        compact();
    }

private:
    struct Entry {
        double length;
        std::uint32_t a, b, version_a, version_b;

        bool operator<(const Entry& o) const {
            if (length != o.length)
                return length > o.length;
            return a != o.a ? a > o.a : b > o.b;
        }
    };

    void push(std::uint32_t a, std::uint32_t b) {
        const double length = glm::length(mesh_.positions[a] - mesh_.positions[b]);
        queue_.push({length / (size_[a] + size_[b]), a, b, version_[a], version_[b]});
    }

    bool has(std::uint32_t triangle, std::uint32_t v) const {
        const auto& t = mesh_.triangles[triangle];
        return t[0] == v || t[1] == v || t[2] == v;
    }

    std::vector<std::uint32_t> neighbours(std::uint32_t v) const {
        std::vector<std::uint32_t> ring;
        for (const std::uint32_t t : around_[v])
            for (const std::uint32_t u : mesh_.triangles[t])
                if (u != v)
                    ring.push_back(u);
        std::ranges::sort(ring);
        ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
        return ring;
    }

    // Link condition (the result stays manifold), no triangle turned over, no overfull vertex.
    bool mayCollapse(std::uint32_t a, std::uint32_t b) const {
        const std::vector<std::uint32_t> ring_a = neighbours(a);
        const std::vector<std::uint32_t> ring_b = neighbours(b);
        std::vector<std::uint32_t> both;
        std::ranges::set_intersection(ring_a, ring_b, std::back_inserter(both));
        if (both.size() != 2 || ring_a.size() + ring_b.size() > 13)
            return false;
        for (const std::uint32_t v : both)
            if (around_[v].size() <= 4)
                return false;
        const glm::dvec3 middle = (mesh_.positions[a] + mesh_.positions[b]) * 0.5;
        return staysUpright(a, b, middle) && staysUpright(b, a, middle);
    }

    bool staysUpright(std::uint32_t v, std::uint32_t other, const glm::dvec3& to) const {
        for (const std::uint32_t t : around_[v]) {
            if (has(t, other))
                continue;
            std::array<glm::dvec3, 3> p{};
            std::array<glm::dvec3, 3> q{};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t u = mesh_.triangles[t][k];
                p[k] = mesh_.positions[u];
                q[k] = u == v ? to : p[k];
            }
            const glm::dvec3 before = glm::cross(p[1] - p[0], p[2] - p[0]);
            const glm::dvec3 after = glm::cross(q[1] - q[0], q[2] - q[0]);
            if (glm::dot(before, after) <= 0.3 * glm::length(before) * glm::length(after))
                return false;
        }
        return true;
    }

    void collapse(std::uint32_t a, std::uint32_t b) {
        mesh_.positions[a] = (mesh_.positions[a] + mesh_.positions[b]) * 0.5;
        size_[a] = (size_[a] + size_[b]) * 0.5;
        for (const std::uint32_t t : around_[b]) {
            if (has(t, a)) {
                for (const std::uint32_t v : mesh_.triangles[t])
                    if (v != b)
                        std::erase(around_[v], t);
                mesh_.triangles[t] = {kNone, kNone, kNone};
                --alive_count_;
            } else {
                std::ranges::replace(mesh_.triangles[t], b, a);
                around_[a].push_back(t);
            }
        }
        around_[b].clear();
        ++version_[a];
        ++version_[b];
        for (const std::uint32_t v : neighbours(a))
            push(std::min(a, v), std::max(a, v));
    }

    void compact() {
        std::erase_if(mesh_.triangles, [](const auto& t) { return t[0] == kNone; });
        std::vector<std::uint32_t> renamed(mesh_.positions.size(), kNone);
        std::vector<glm::dvec3> kept;
        for (auto& t : mesh_.triangles)
            for (std::uint32_t& v : t) {
                if (renamed[v] == kNone) {
                    renamed[v] = static_cast<std::uint32_t>(kept.size());
                    kept.push_back(mesh_.positions[v]);
                }
                v = renamed[v];
            }
        mesh_.positions = std::move(kept);
    }

    Mesh& mesh_;
    std::vector<std::vector<std::uint32_t>> around_; // triangles of a vertex
    std::vector<std::uint32_t> version_;             // rises when the vertex moves
    std::vector<double> size_;
    std::priority_queue<Entry> queue_;
    std::size_t alive_count_ = 0;
};

} // namespace

void coarsen(Mesh& mesh, std::size_t triangle_count, const Field& size) {
    Coarsener(mesh, size).run(triangle_count);
}

} // namespace lodestone::generate
