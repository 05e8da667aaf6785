#include "simplify/pointcloud/merge_builder.h"
#include "simplify/pointcloud/methods.h"
#include "simplify/pointcloud/vertex_grid.h"

#include <algorithm>
#include <limits>

namespace lodestone {

namespace {

// Squared distances to the planes of the faces around each vertex, weighted by area. Every one of
// those planes goes through the vertex, so the quadric about it is its matrix alone.
std::vector<glm::dmat3> vertexQuadrics(const CloudSurface& surface, const JobContext& job) {
    std::vector<glm::dmat3> quadrics(surface.positions.size(), glm::dmat3(0.0));
    for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
        const glm::dvec3 normal = faceVector(surface.points(f));
        const double length = glm::length(normal);
        if (!(length > 0.0))
            continue;
        const glm::dmat3 plane = glm::outerProduct(normal, normal / length);
        for (const std::uint32_t vertex : surface.corners(f))
            quadrics[vertex] += plane;
    }
    return quadrics;
}

struct Place {
    glm::dvec3 point{0.0};
    double error = 0.0;
};

class Cluster {
public:
    Cluster(const CloudSurface& surface,
            std::span<const glm::dmat3> quadrics,
            std::span<const std::uint32_t> members)
        : surface_(surface), quadrics_(quadrics), members_(members) {
        for (const std::uint32_t vertex : members)
            centroid_ += surface.positions[vertex] / static_cast<double>(members.size());
        for (const std::uint32_t vertex : members) {
            const glm::dvec3 from = surface.positions[vertex] - centroid_;
            matrix_ += quadrics[vertex];
            linear_ += quadrics[vertex] * from;
            constant_ += glm::dot(from, quadrics[vertex] * from);
        }
    }

    // Centroid, the member nearest to it, the quadric's optimum if within reach: best first.
    std::array<Place, 3> places(double reach) const {
        std::array<Place, 3> found{place(centroid_), place(nearestMember()), place(optimum(reach))};
        std::ranges::stable_sort(found, {}, &Place::error);
        return found;
    }

private:
    Place place(const glm::dvec3& point) const {
        const glm::dvec3 x = point - centroid_;
        return {point, glm::dot(x, matrix_ * x) - 2.0 * glm::dot(x, linear_) + constant_};
    }

    glm::dvec3 nearestMember() const {
        glm::dvec3 nearest = centroid_;
        double nearest2 = std::numeric_limits<double>::max();
        for (const std::uint32_t vertex : members_) {
            const glm::dvec3 away = surface_.positions[vertex] - centroid_;
            if (glm::dot(away, away) < nearest2) {
                nearest2 = glm::dot(away, away);
                nearest = surface_.positions[vertex];
            }
        }
        return nearest;
    }

    // Drawn a little towards the centroid, so that flat and straight clusters are well-posed.
    glm::dvec3 optimum(double reach) const {
        constexpr double kTikhonov = 1e-3;
        const double trace = matrix_[0][0] + matrix_[1][1] + matrix_[2][2];
        const glm::dmat3 regular = matrix_ + glm::dmat3(trace * kTikhonov);
        if (!(trace > 0.0))
            return centroid_;
        const glm::dvec3 x = glm::inverse(regular) * linear_;
        return glm::dot(x, x) <= reach * reach ? centroid_ + x : centroid_;
    }

    const CloudSurface& surface_;
    std::span<const glm::dmat3> quadrics_;
    std::span<const std::uint32_t> members_;
    glm::dvec3 centroid_{0.0};
    glm::dmat3 matrix_{0.0};
    glm::dvec3 linear_{0.0};
    double constant_ = 0.0;
};

} // namespace

Merges sphericalScanning(const CloudSurface& surface,
                         double radius,
                         Fidelity fidelity,
                         const JobContext& job) {
    MergeBuilder builder(surface, fidelity, job);
    if (job.stopRequested())
        return {};
    const std::vector<glm::dmat3> quadrics = vertexQuadrics(surface, job);
    if (job.stopRequested())
        return {};
    std::vector<bool> taken(surface.positions.size(), true); // also those without a face
    for (const std::uint32_t vertex : surface.wedge_vertex)
        if (vertex != kNone)
            taken[vertex] = false;
    VertexGrid grid(surface.positions, taken, radius);
    std::vector<std::uint32_t> inside;
    for (std::size_t v = 0; v < surface.positions.size() && !stopsAt(v, job); ++v) {
        if (taken[v])
            continue;
        inside.clear();
        grid.takeWithin(surface.positions[v], inside);
        for (const std::uint32_t vertex : inside)
            taken[vertex] = true;
        if (inside.size() < 2)
            continue;
        const std::array<Place, 3> places = Cluster(surface, quadrics, inside).places(radius);
        const auto is_sound = [&](const Place& place) {
            return fidelity == Fidelity::Literal || !builder.turnsFace(inside, place.point);
        };
        const auto sound = std::ranges::find_if(places, is_sound);
        builder.mergeAnyway(inside, (sound == places.end() ? places[0] : *sound).point);
    }
    return builder.finish();
}

} // namespace lodestone
