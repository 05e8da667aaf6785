#include "simplify/pointcloud/edge_table.h"
#include "simplify/pointcloud/retriangulate.h"

#include <cmath>

namespace lodestone {

namespace {

constexpr double kFlatCosine = 0.866; // faces that meet within 30 degrees count as one plane

// The two faces of an edge: first = (a, b, c), second = (b, a, d); wedges.
struct Quad {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::uint32_t c = 0;
    std::uint32_t d = 0;
};

double cosine(const glm::dvec3& u, const glm::dvec3& v) {
    const double lengths = std::sqrt(glm::dot(u, u) * glm::dot(v, v));
    return lengths > 0.0 ? glm::dot(u, v) / lengths : -1.0;
}

class Flipper {
public:
    Flipper(CloudSurface& surface, const JobContext& job)
        : surface_(surface), job_(job), edges_(3 * surface.faces.size()) {
        for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
            const Triangle corners = surface.corners(f);
            for (std::size_t k = 0; k < 3; ++k)
                edges_.addFace(corners[k], corners[(k + 1) % 3], f);
        }
        region_ = surface.changed;
    }

    void run() {
        queueAll();
        std::size_t rounds = 0;
        // Flat Delaunay ends by itself; on a curved surface the limit makes sure of it.
        const std::size_t limit = 16 * queue_.size();
        for (std::size_t head = 0; head < queue_.size() && rounds < limit; ++head, ++rounds) {
            if (stopsAt(rounds, job_))
                return;
            const std::uint32_t slot = queue_[head];
            queued_[slot] = false;
            Quad quad;
            if (!edges_.full() && quadOf(slot, quad) && wantsFlip(quad))
                flip(slot, quad);
        }
    }

private:
    std::uint32_t vertex(std::uint32_t wedge) const { return surface_.wedge_vertex[wedge]; }

    const glm::dvec3& point(std::uint32_t wedge) const { return surface_.positions[vertex(wedge)]; }

    void push(std::uint32_t slot) {
        if (queued_[slot])
            return;
        queued_[slot] = true;
        queue_.push_back(slot);
    }

    void queueAll() {
        queued_.assign(edges_.slotCount(), false);
        for (std::uint32_t f = 0; f < surface_.faces.size(); ++f) {
            if (!region_[f])
                continue;
            const Triangle corners = surface_.corners(f);
            for (std::size_t k = 0; k < 3; ++k)
                push(edges_.at(corners[k], corners[(k + 1) % 3]));
        }
    }

    // False where an edge is a border, a seam, non-manifold or not consistently oriented.
    bool quadOf(std::uint32_t slot, Quad& quad) {
        const CloudEdge& edge = edges_[slot];
        if (edge.face_count != 2)
            return false;
        quad.first = edge.faces[0];
        quad.second = edge.faces[1];
        if (surface_.primitive[quad.first] != surface_.primitive[quad.second] ||
            (!region_[quad.first] && !region_[quad.second]))
            return false;
        const Triangle& face = surface_.faces[quad.first];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t v = vertex(face[k]);
            if (v == edge.low || v == edge.high)
                continue;
            quad.c = face[k];
            quad.a = face[(k + 1) % 3];
            quad.b = face[(k + 2) % 3];
        }
        const Triangle& other = surface_.faces[quad.second];
        for (std::size_t k = 0; k < 3; ++k)
            if (other[k] == quad.b && other[(k + 1) % 3] == quad.a) {
                quad.d = other[(k + 2) % 3];
                return vertex(quad.c) != vertex(quad.d);
            }
        return false;
    }

    bool wantsFlip(const Quad& quad) {
        const glm::dvec3& a = point(quad.a);
        const glm::dvec3& b = point(quad.b);
        const glm::dvec3& c = point(quad.c);
        const glm::dvec3& d = point(quad.d);
        // Angles at c and d together above 180 degrees: d is inside the circle of a, b, c.
        const double cos_c = cosine(a - c, b - c);
        const double cos_d = cosine(a - d, b - d);
        constexpr double kMargin = 1e-6;
        if (!(cos_c + cos_d < -kMargin))
            return false;
        const glm::dvec3 before1 = faceVector({a, b, c});
        const glm::dvec3 before2 = faceVector({b, a, d});
        const glm::dvec3 after1 = faceVector({a, d, c});
        const glm::dvec3 after2 = faceVector({d, b, c});
        const glm::dvec3 mean = before1 + before2;
        if (cosine(before1, before2) < kFlatCosine || cosine(after1, after2) < kFlatCosine ||
            glm::dot(after1, mean) <= 0.0 || glm::dot(after2, mean) <= 0.0)
            return false;
        return edges_[edges_.at(vertex(quad.c), vertex(quad.d))].face_count == 0;
    }

    void flip(std::uint32_t slot, const Quad& quad) {
        surface_.faces[quad.first] = {quad.a, quad.d, quad.c};
        surface_.faces[quad.second] = {quad.d, quad.b, quad.c};
        for (const std::uint32_t face : {quad.first, quad.second}) {
            surface_.changed[face] = 1;
            surface_.two_sided[face] = 0;
        }
        edges_[slot].face_count = 0;
        CloudEdge& made = edges_[edges_.at(vertex(quad.c), vertex(quad.d))];
        made.faces = {quad.first, quad.second};
        made.face_count = 2;
        const std::uint32_t ad = edges_.at(vertex(quad.a), vertex(quad.d));
        const std::uint32_t bc = edges_.at(vertex(quad.b), vertex(quad.c));
        edges_[ad].replace(quad.second, quad.first);
        edges_[bc].replace(quad.first, quad.second);
        push(ad);
        push(bc);
        push(edges_.at(vertex(quad.a), vertex(quad.c)));
        push(edges_.at(vertex(quad.b), vertex(quad.d)));
    }

    CloudSurface& surface_;
    const JobContext& job_;
    EdgeTable edges_;
    std::vector<std::uint8_t> region_; // [faces] what may be flipped
    std::vector<bool> queued_;         // [slots]
    std::vector<std::uint32_t> queue_; // slots
};

} // namespace

void flipToDelaunay(CloudSurface& surface, const JobContext& job) {
    Flipper(surface, job).run();
}

} // namespace lodestone
