#include "simplify/pointcloud/methods.h"
#include "simplify/pointcloud/polygon.h"
#include "simplify/pointcloud/vertex_fan.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>

namespace lodestone {

namespace {

constexpr double kStraightDeg = 15.0; // a border or seam that bends less is straight
constexpr double kLeastCosine = 0.17; // new faces stay within 80 degrees of the old mean

double cosineDeg(double degrees) {
    return std::cos(glm::radians(degrees));
}

// A set of edges, sized once.
class EdgeSet {
public:
    explicit EdgeSet(std::size_t capacity)
        : slots_(std::bit_ceil(std::max<std::size_t>(16, 2 * capacity)), kFree) {}

    bool contains(std::uint32_t a, std::uint32_t b) const { return slots_[slotOf(a, b)] != kFree; }

    void insert(std::uint32_t a, std::uint32_t b) { slots_[slotOf(a, b)] = keyOf(a, b); }

private:
    static constexpr std::uint64_t kFree = ~std::uint64_t{0};

    static std::uint64_t keyOf(std::uint32_t a, std::uint32_t b) {
        return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
    }

    std::size_t slotOf(std::uint32_t a, std::uint32_t b) const {
        const std::uint64_t key = keyOf(a, b);
        std::uint64_t slot = key * 0x9E3779B97F4A7C15ull;
        slot ^= slot >> 32;
        slot &= slots_.size() - 1;
        while (slots_[slot] != kFree && slots_[slot] != key)
            slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }

    std::vector<std::uint64_t> slots_;
};

// The faces that close a hole.
struct Patch {
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> primitives;
    double error = 0.0; // distance of the removed vertex
};

class FaceAnglePass {
public:
    FaceAnglePass(CloudSurface& surface, const FaceAngleOptions& options)
        : surface_(surface), options_(options), stars_(buildStars(surface)),
          cosine_(cosineDeg(options.angle_deg)), normals_(surface.faces.size()),
          areas_(surface.faces.size()), kept_(surface.positions.size(), false),
          gone_(surface.faces.size(), false), new_edges_(3 * surface.faces.size()) {
        double area = 0.0;
        for (std::size_t f = 0; f < surface.faces.size(); ++f) {
            normals_[f] = faceVector(surface.points(f));
            areas_[f] = glm::length(normals_[f]);
            area += areas_[f];
            if (areas_[f] > 0.0)
                normals_[f] /= areas_[f];
        }
        largest_area_ = area * options.area_share;
    }

    // The angle and area tests alone.
    bool isFlat(std::uint32_t vertex) const;

    // Removes what can be removed of the vertices to look at; decided: instead of the angle test.
    // Returns how many.
    std::size_t
    run(const std::vector<bool>& look, const std::vector<bool>* decided, const JobContext& job);

    // Vertices around which something has changed: only there can the next pass find more.
    std::vector<bool> takeNeighbours() { return std::move(kept_); }

private:
    bool closeHole(std::uint32_t vertex, Patch& patch);
    bool closePart(std::uint32_t vertex, std::size_t begin, std::size_t end, Patch& patch);
    bool isStraight(std::uint32_t vertex) const;
    bool projects(const glm::dvec3& centre, const PlaneAxes& axes) const;
    bool isNew(std::span<const Triangle> faces, std::size_t ring_size) const;
    bool hasEdge(std::uint32_t a, std::uint32_t b) const;
    std::uint32_t cornerWedge(std::size_t spoke,
                              const glm::dvec3& normal,
                              std::size_t begin,
                              std::size_t end) const;
    void commit(std::uint32_t vertex, const Patch& patch);

    CloudSurface& surface_;
    const FaceAngleOptions& options_;
    Stars stars_; // as the pass began
    double cosine_;
    double largest_area_ = 0.0;
    std::vector<glm::dvec3> normals_; // [faces] unit
    std::vector<double> areas_;       // [faces] doubled
    std::vector<bool> kept_;          // [vertices] beside a removed one
    std::vector<bool> gone_;          // [faces]
    EdgeSet new_edges_;
    VertexFan fan_;
};

bool FaceAnglePass::isFlat(std::uint32_t vertex) const {
    const std::span<const std::uint32_t> star = stars_.of(vertex);
    constexpr std::size_t kMostPairs = 64; // larger stars are left alone anyway
    if (star.empty() || star.size() > kMostPairs)
        return false;
    double area = 0.0;
    for (std::size_t i = 0; i < star.size(); ++i) {
        area += areas_[star[i]];
        for (std::size_t k = 0; k < i; ++k)
            if (glm::dot(normals_[star[i]], normals_[star[k]]) <= cosine_ &&
                areas_[star[i]] > 0.0 && areas_[star[k]] > 0.0)
                return false;
    }
    return area <= largest_area_;
}

// No seam, or one that runs (nearly) straight through.
bool FaceAnglePass::isStraight(std::uint32_t vertex) const {
    if (fan_.seams.empty())
        return true;
    if (fan_.seams.size() != 2)
        return false;
    const glm::dvec3& centre = surface_.positions[vertex];
    const glm::dvec3 in = surface_.positions[fan_.spokes[fan_.seams[0]].vertex] - centre;
    const glm::dvec3 out = surface_.positions[fan_.spokes[fan_.seams[1]].vertex] - centre;
    const double limit = cosineDeg(std::min(options_.angle_deg, kStraightDeg));
    const double lengths = glm::length(in) * glm::length(out);
    return lengths > 0.0 && -glm::dot(in, out) >= limit * lengths;
}

// Whether the fan unrolls in the plane: every face counter-clockwise, once around at most.
bool FaceAnglePass::projects(const glm::dvec3& centre, const PlaneAxes& axes) const {
    const auto flat = [&](std::size_t spoke) {
        const glm::dvec3 away =
            surface_.positions[fan_.spokes[spoke % fan_.spokes.size()].vertex] - centre;
        return glm::dvec2(glm::dot(away, axes.u), glm::dot(away, axes.v));
    };
    double turn = 0.0;
    for (std::size_t i = 0; i < fan_.faces.size(); ++i) {
        const glm::dvec2 a = flat(i);
        const glm::dvec2 b = flat(i + 1);
        const double sine = a.x * b.y - a.y * b.x;
        if (!(sine > 0.0))
            return false;
        turn += std::atan2(sine, glm::dot(a, b));
    }
    return turn < glm::two_pi<double>() + 1e-6;
}

bool FaceAnglePass::hasEdge(std::uint32_t a, std::uint32_t b) const {
    if (new_edges_.contains(a, b))
        return true;
    return std::ranges::any_of(stars_.of(a), [&](std::uint32_t f) {
        if (gone_[f])
            return false;
        const Triangle corners = surface_.corners(f);
        return corners[0] == b || corners[1] == b || corners[2] == b;
    });
}

// Of the two wedges beside a spoke that belong to the part: that of the face turned like the new.
std::uint32_t FaceAnglePass::cornerWedge(std::size_t spoke,
                                         const glm::dvec3& normal,
                                         std::size_t begin,
                                         std::size_t end) const {
    const std::size_t count = fan_.faces.size();
    const Spoke& at = fan_.spokes[spoke % fan_.spokes.size()];
    if (spoke == begin && !(fan_.closed && end - begin == count))
        return at.wedge_after;
    if (spoke == end)
        return at.wedge_before;
    const glm::dvec3& before = normals_[fan_.faces[(spoke + count - 1) % count]];
    const glm::dvec3& after = normals_[fan_.faces[spoke % count]];
    return glm::dot(before, normal) > glm::dot(after, normal) ? at.wedge_before : at.wedge_after;
}

// The part of the hole between two seams (or all of it): faces begin..end, spokes begin..end.
bool FaceAnglePass::closePart(std::uint32_t vertex,
                              std::size_t begin,
                              std::size_t end,
                              Patch& patch) {
    const std::size_t count = fan_.faces.size();
    const bool whole = fan_.closed && end - begin == count;
    const glm::dvec3& centre = surface_.positions[vertex];
    glm::dvec3 normal(0.0);
    for (std::size_t i = begin; i < end; ++i)
        normal += normals_[fan_.faces[i % count]] * areas_[fan_.faces[i % count]];
    if (!(glm::length(normal) > 0.0))
        return false;
    normal = glm::normalize(normal);
    const PlaneAxes axes = axesAcross(normal);
    FlatPolygon polygon;
    std::vector<std::size_t> spokes;
    for (std::size_t i = begin; i < end + (whole ? 0 : 1); ++i) {
        spokes.push_back(i);
        const glm::dvec3 away =
            surface_.positions[fan_.spokes[i % fan_.spokes.size()].vertex] - centre;
        polygon.points.emplace_back(glm::dot(away, axes.u), glm::dot(away, axes.v));
    }
    std::vector<Triangle> triangles;
    if (!projects(centre, axes) || spokes.size() < 3 || !triangulate(polygon, triangles))
        return false;
    double nearest = std::numeric_limits<double>::max();
    for (const Triangle& triangle : triangles) {
        Triangle3d points;
        for (std::size_t k = 0; k < 3; ++k)
            points[k] =
                surface_.positions[fan_.spokes[spokes[triangle[k]] % fan_.spokes.size()].vertex];
        const glm::dvec3 face = faceVector(points);
        const double length = glm::length(face);
        if (!(length > 0.0) || glm::dot(face, normal) < kLeastCosine * length)
            return false;
        nearest = std::min(nearest, std::abs(glm::dot(face, centre - points[0])) / length);
        Triangle wedges;
        for (std::size_t k = 0; k < 3; ++k)
            wedges[k] = cornerWedge(spokes[triangle[k]], face, begin, end);
        patch.faces.push_back(wedges);
        patch.primitives.push_back(surface_.primitive[fan_.faces[begin % count]]);
    }
    patch.error = std::max(patch.error, nearest);
    return true;
}

// No edge across the hole is there already, and no face that the new ones would lie upon.
bool FaceAnglePass::isNew(std::span<const Triangle> faces, std::size_t ring_size) const {
    const auto vertex_of = [&](std::uint32_t wedge) { return surface_.wedge_vertex[wedge]; };
    const auto is_rim = [&](std::uint32_t a, std::uint32_t b) {
        for (std::size_t i = 0; i < fan_.faces.size(); ++i)
            if (fan_.spokes[i].vertex == a && fan_.spokes[(i + 1) % fan_.spokes.size()].vertex == b)
                return true;
        return false;
    };
    for (const Triangle& face : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = vertex_of(face[k]);
            const std::uint32_t b = vertex_of(face[(k + 1) % 3]);
            if (!is_rim(a, b) && hasEdge(a, b))
                return false;
        }
    if (ring_size > 3)
        return true;
    // A single face: its mirror image may be there, on the far side of a thin spike.
    const Triangle corners{vertex_of(faces[0][0]), vertex_of(faces[0][1]), vertex_of(faces[0][2])};
    return !new_edges_.contains(corners[0], corners[1]) &&
           std::ranges::none_of(stars_.of(corners[0]), [&](std::uint32_t f) {
               if (gone_[f])
                   return false;
               const Triangle other = surface_.corners(f);
               return std::ranges::find(other, corners[1]) != other.end() &&
                      std::ranges::find(other, corners[2]) != other.end();
           });
}

bool FaceAnglePass::closeHole(std::uint32_t vertex, Patch& patch) {
    if (!makeFan(surface_, vertex, stars_.of(vertex), fan_) || !isStraight(vertex))
        return false;
    const std::size_t count = fan_.faces.size();
    if (fan_.seams.empty())
        return closePart(vertex, 0, count, patch);
    const std::size_t first = fan_.seams[0];
    const std::size_t second = fan_.seams[1];
    if (!closePart(vertex, first, second, patch))
        return false;
    return !fan_.closed || closePart(vertex, second, first + count, patch);
}

void FaceAnglePass::commit(std::uint32_t vertex, const Patch& patch) {
    for (const std::uint32_t face : fan_.faces)
        gone_[face] = true;
    for (std::size_t i = 0; i < patch.faces.size(); ++i) {
        const std::uint32_t slot = fan_.faces[i]; // there are fewer new faces than old
        surface_.faces[slot] = patch.faces[i];
        surface_.primitive[slot] = patch.primitives[i];
        surface_.changed[slot] = 1;
        surface_.two_sided[slot] = 0;
        for (std::size_t k = 0; k < 3; ++k)
            new_edges_.insert(surface_.wedge_vertex[patch.faces[i][k]],
                              surface_.wedge_vertex[patch.faces[i][(k + 1) % 3]]);
    }
    for (std::size_t i = patch.faces.size(); i < fan_.faces.size(); ++i)
        surface_.faces[fan_.faces[i]] = {kNone, kNone, kNone};
    for (const Spoke& spoke : fan_.spokes)
        kept_[spoke.vertex] = true;
    surface_.stands_for[vertex] = kNone;
    surface_.removal_error = std::max(surface_.removal_error, patch.error);
}

std::size_t FaceAnglePass::run(const std::vector<bool>& look,
                               const std::vector<bool>* decided,
                               const JobContext& job) {
    std::size_t removed = 0;
    for (std::uint32_t v = 0; v < kept_.size() && !stopsAt(v, job); ++v) {
        if (!look[v] || kept_[v] || !(decided ? (*decided)[v] : isFlat(v)))
            continue;
        Patch patch;
        if (!closeHole(v, patch) || !isNew(patch.faces, fan_.faces.size()))
            continue;
        commit(v, patch);
        ++removed;
    }
    return removed;
}

} // namespace

void removeFlatVertices(CloudSurface& surface,
                        const FaceAngleOptions& options,
                        const JobContext& job) {
    std::vector<bool> decided;
    if (options.fidelity == Fidelity::Literal) {
        const FaceAnglePass pass(surface, options);
        decided.resize(surface.positions.size());
        for (std::uint32_t v = 0; v < decided.size(); ++v)
            decided[v] = pass.isFlat(v);
    }
    std::vector<bool> look(surface.positions.size(), true);
    for (std::uint32_t p = 0; p < options.passes && !job.stopRequested(); ++p) {
        FaceAnglePass pass(surface, options);
        if (pass.run(look, decided.empty() ? nullptr : &decided, job) == 0)
            break;
        look = pass.takeNeighbours();
        keepFaces(surface, [&](std::size_t f) { return surface.faces[f][0] != kNone; });
        forgetUnusedWedges(surface);
    }
}

} // namespace lodestone
