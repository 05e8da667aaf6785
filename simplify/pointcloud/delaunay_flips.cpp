#include "simplify/pointcloud/edge_table.h"
#include "simplify/pointcloud/retriangulate.h"

#include <cmath>

namespace lodestone {

namespace {

constexpr double kFlatCosine = 0.866; // faces that meet within 30 degrees count as one plane

// The two faces of an edge: first = (c, a, b) from corner `first_at` on, second = (d, b, a) from
// corner `second_at` on; wedges.
struct Quad {
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    std::size_t first_at = 0;
    std::size_t second_at = 0;
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
        : surface_(surface), job_(job), edges_(surface, job), region_(surface.changed) {}

    void run() {
        if (job_.stopRequested())
            return;
        queueAll();
        if (job_.stopRequested())
            return;
        std::size_t rounds = 0;
        // Flat Delaunay ends by itself; on a curved surface the limit makes sure of it.
        const std::size_t limit = 16 * queue_.size();
        for (std::size_t head = 0; head < queue_.size() && rounds < limit; ++head, ++rounds) {
            if (stopsAt(rounds, job_))
                return;
            const std::uint32_t edge = queue_[head];
            queued_[edge] = false;
            Quad quad;
            if (quadOf(edge, quad) && wantsFlip(quad))
                flip(edge, quad);
        }
    }

private:
    std::uint32_t vertex(std::uint32_t wedge) const { return surface_.wedge_vertex[wedge]; }

    const glm::dvec3& point(std::uint32_t wedge) const { return surface_.positions[vertex(wedge)]; }

    void push(std::uint32_t edge) {
        if (queued_[edge])
            return;
        queued_[edge] = true;
        queue_.push_back(edge);
    }

    void queueAll() {
        queued_.assign(edges_.size(), false);
        for (std::uint32_t f = 0; f < surface_.faces.size(); ++f)
            if (region_[f])
                for (const std::uint32_t edge : edges_.sides(f))
                    push(edge);
    }

    // False where an edge is a border, a seam, non-manifold or not consistently oriented.
    bool quadOf(std::uint32_t number, Quad& quad) {
        const CloudEdge& edge = edges_[number];
        if (edge.face_count != 2)
            return false;
        quad.first = edge.faces[0];
        quad.second = edge.faces[1];
        if (surface_.primitive[quad.first] != surface_.primitive[quad.second] ||
            (!region_[quad.first] && !region_[quad.second]))
            return false;
        quad.first_at = across(quad.first, number);
        quad.second_at = across(quad.second, number);
        const Triangle& first = surface_.faces[quad.first];
        const Triangle& second = surface_.faces[quad.second];
        quad.c = first[quad.first_at];
        quad.a = first[(quad.first_at + 1) % 3];
        quad.b = first[(quad.first_at + 2) % 3];
        quad.d = second[quad.second_at];
        return second[(quad.second_at + 1) % 3] == quad.b &&
               second[(quad.second_at + 2) % 3] == quad.a && vertex(quad.c) != vertex(quad.d);
    }

    // The corner of a face that is not on its edge.
    std::size_t across(std::uint32_t face, std::uint32_t edge) {
        const Triangle& sides = edges_.sides(face);
        return sides[1] == edge ? 0 : sides[2] == edge ? 1 : 2;
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
        return !edges_.contains(vertex(quad.c), vertex(quad.d));
    }

    void flip(std::uint32_t edge, const Quad& quad) {
        const Triangle first = edges_.sides(quad.first);
        const Triangle second = edges_.sides(quad.second);
        const std::uint32_t ca = first[quad.first_at];
        const std::uint32_t bc = first[(quad.first_at + 2) % 3];
        const std::uint32_t db = second[quad.second_at];
        const std::uint32_t ad = second[(quad.second_at + 2) % 3];
        surface_.faces[quad.first] = {quad.a, quad.d, quad.c};
        surface_.faces[quad.second] = {quad.d, quad.b, quad.c};
        edges_.sides(quad.first) = {ad, edge, ca};
        edges_.sides(quad.second) = {db, bc, edge};
        for (const std::uint32_t face : {quad.first, quad.second}) {
            surface_.changed[face] = 1;
            surface_.two_sided[face] = 0;
        }
        edges_.move(edge, vertex(quad.c), vertex(quad.d));
        edges_[ad].replace(quad.second, quad.first);
        edges_[bc].replace(quad.first, quad.second);
        for (const std::uint32_t around : {ad, bc, ca, db})
            push(around);
    }

    CloudSurface& surface_;
    const JobContext& job_;
    EdgeTable edges_;
    std::vector<std::uint8_t> region_; // [faces] what may be flipped
    std::vector<bool> queued_;         // [edges]
    std::vector<std::uint32_t> queue_; // edges
};

} // namespace

void flipToDelaunay(CloudSurface& surface, const JobContext& job) {
    Flipper(surface, job).run();
}

} // namespace lodestone
