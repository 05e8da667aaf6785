#include "simplify/pointcloud/methods.h"
#include "simplify/pointcloud/polygon.h"
#include "simplify/pointcloud/vertex_fan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lodestone {

namespace {

constexpr double kStraightDeg = 15.0; // a border or seam that bends less is straight
constexpr double kLeastCosine = 0.17; // new faces stay within 80 degrees of the old mean

double cosineDeg(double degrees) {
    return std::cos(glm::radians(degrees));
}

// The edges that a pass has made, by vertex.
class NewEdges {
public:
    explicit NewEdges(std::size_t vertex_count) : first_(vertex_count, kNone) {}

    bool contains(std::uint32_t a, std::uint32_t b) const {
        for (std::uint32_t at = first_[a]; at != kNone; at = ends_[at].next)
            if (ends_[at].vertex == b)
                return true;
        return false;
    }

    void insert(std::uint32_t a, std::uint32_t b) {
        append(a, b);
        append(b, a);
    }

private:
    struct End {
        std::uint32_t vertex = 0;
        std::uint32_t next = kNone;
    };

    void append(std::uint32_t at, std::uint32_t other) {
        ends_.push_back({other, first_[at]});
        first_[at] = static_cast<std::uint32_t>(ends_.size() - 1);
    }

    std::vector<std::uint32_t> first_; // [vertices] into ends_
    std::vector<End> ends_;
};

// The faces that close a hole.
struct Patch {
    std::vector<Triangle> faces;
    std::vector<std::uint32_t> primitives;
    std::vector<std::array<std::uint32_t, 2>> edges; // vertices; that no face had before
    double error = 0.0;                              // distance of the removed vertex

    void clear() {
        edges.clear();
        faces.clear();
        primitives.clear();
        error = 0.0;
    }
};

std::vector<Triangle> cornersOf(const CloudSurface& surface) {
    std::vector<Triangle> corners(surface.faces.size());
    for (std::size_t f = 0; f < corners.size(); ++f)
        corners[f] = surface.corners(f);
    return corners;
}

// Whether a fan unrolls in the plane: every face counter-clockwise, once around at most. rim: its
// spokes as seen from the centre, of a closed one the first again.
bool unrolls(std::span<const glm::dvec2> rim) {
    const auto side = [](const glm::dvec2& a, const glm::dvec2& b) {
        return a.x * b.y - a.y * b.x;
    };
    bool behind = false; // past half a turn
    for (std::size_t i = 0; i + 1 < rim.size(); ++i) {
        if (!(side(rim[i], rim[i + 1]) > 0.0))
            return false;
        const double turned = side(rim[0], rim[i + 1]);
        if (behind && (turned > 0.0 || (turned == 0.0 && i + 2 < rim.size())))
            return false;
        behind = behind || turned < 0.0;
    }
    return true;
}

class FaceAnglePass {
public:
    // Not to be used where asked to stop.
    FaceAnglePass(CloudSurface& surface, const FaceAngleOptions& options, const JobContext& job)
        : surface_(surface), options_(options), corners_(cornersOf(surface)),
          stars_(buildStars(corners_, surface.positions.size(), job)),
          cosine_(cosineDeg(options.angle_deg)), kept_(surface.positions.size(), false),
          gone_(surface.faces.size(), false), new_edges_(surface.positions.size()) {
        if (job.stopRequested())
            return;
        normals_.resize(surface.faces.size());
        areas_.resize(surface.faces.size());
        double area = 0.0;
        for (std::size_t f = 0; f < surface.faces.size() && !stopsAt(f, job); ++f) {
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
    bool isNew(const Patch& patch) const;

    std::uint32_t rimVertex(std::size_t spoke) const {
        const std::size_t count = fan_.spokes.size();
        return fan_.spokes[spoke < count ? spoke : spoke - count].vertex;
    }

    const glm::dvec3& rimPoint(std::size_t spoke) const {
        return surface_.positions[rimVertex(spoke)];
    }

    bool hasEdge(std::uint32_t a, std::uint32_t b) const;
    std::uint32_t cornerWedge(std::size_t spoke,
                              const glm::dvec3& normal,
                              std::size_t begin,
                              std::size_t end) const;
    void commit(std::uint32_t vertex, const Patch& patch);

    CloudSurface& surface_;
    const FaceAngleOptions& options_;
    std::vector<Triangle> corners_; // [faces] vertices, as the pass began
    Stars stars_;                   // as the pass began
    double cosine_;
    double largest_area_ = 0.0;
    std::vector<glm::dvec3> normals_; // [faces] unit
    std::vector<double> areas_;       // [faces] doubled
    std::vector<bool> kept_;          // [vertices] beside a removed one
    std::vector<bool> gone_;          // [faces]
    NewEdges new_edges_;
    VertexFan fan_; // of the vertex that is looked at
    FlatPolygon polygon_;
    std::vector<glm::dvec2> rim_;
    std::vector<Triangle> triangles_;
};

bool FaceAnglePass::isFlat(std::uint32_t vertex) const {
    const std::span<const std::uint32_t> star = stars_.of(vertex);
    constexpr std::size_t kMostPairs = 64; // larger stars are left alone anyway
    if (star.empty() || star.size() > kMostPairs)
        return false;
    double area = 0.0;
    for (std::size_t i = 0; i < star.size(); ++i) {
        const std::uint32_t face = star[i] / 3;
        area += areas_[face];
        if (!(areas_[face] > 0.0))
            continue;
        for (std::size_t k = 0; k < i; ++k)
            if (areas_[star[k] / 3] > 0.0 &&
                glm::dot(normals_[face], normals_[star[k] / 3]) <= cosine_)
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

// Now: an edge between two vertices beside a hole is never lost.
bool FaceAnglePass::hasEdge(std::uint32_t a, std::uint32_t b) const {
    return new_edges_.contains(a, b) ||
           std::ranges::any_of(stars_.of(a), [&](std::uint32_t corner) {
               const Triangle& face = corners_[corner / 3];
               return face[(corner + 1) % 3] == b || face[(corner + 2) % 3] == b;
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
    rim_.clear();
    for (std::size_t i = 0; i <= count; ++i) {
        const glm::dvec3 away = rimPoint(i) - centre;
        rim_.emplace_back(glm::dot(away, axes.u), glm::dot(away, axes.v));
    }
    polygon_.points.clear();
    for (std::size_t i = begin; i < end + (whole ? 0 : 1); ++i)
        polygon_.points.push_back(rim_[i > count ? i - count : i]);
    triangles_.clear();
    if (polygon_.points.size() < 3 || !unrolls(rim_) || !triangulate(polygon_, triangles_))
        return false;
    const auto add_edge = [&](std::size_t a, std::size_t b) {
        patch.edges.push_back({rimVertex(begin + a), rimVertex(begin + b)});
    };
    if (!whole)
        add_edge(0, polygon_.points.size() - 1);
    for (std::size_t i = 0; i + 1 < triangles_.size(); ++i)
        add_edge(triangles_[i][2], triangles_[i][0]);
    double nearest = std::numeric_limits<double>::max();
    for (const Triangle& triangle : triangles_) {
        const Triangle3d points{rimPoint(begin + triangle[0]),
                                rimPoint(begin + triangle[1]),
                                rimPoint(begin + triangle[2])};
        const glm::dvec3 face = faceVector(points);
        const double length = glm::length(face);
        if (!(length > 0.0) || glm::dot(face, normal) < kLeastCosine * length)
            return false;
        nearest = std::min(nearest, std::abs(glm::dot(face, centre - points[0])) / length);
        Triangle wedges;
        for (std::size_t k = 0; k < 3; ++k)
            wedges[k] = cornerWedge(begin + triangle[k], face, begin, end);
        patch.faces.push_back(wedges);
        patch.primitives.push_back(surface_.primitive[fan_.faces[begin % count]]);
    }
    patch.error = std::max(patch.error, nearest);
    return true;
}

// No edge across the hole is there already, and no face that the new ones would lie upon.
bool FaceAnglePass::isNew(const Patch& patch) const {
    for (const auto& [a, b] : patch.edges)
        if (hasEdge(a, b))
            return false;
    if (fan_.faces.size() > 3)
        return true;
    // A single face: its mirror image may be there, on the far side of a thin spike, or the pass
    // may have put it there.
    const std::uint32_t first = surface_.wedge_vertex[patch.faces[0][0]];
    const std::uint32_t second = surface_.wedge_vertex[patch.faces[0][1]];
    const std::uint32_t third = surface_.wedge_vertex[patch.faces[0][2]];
    return !new_edges_.contains(first, second) &&
           std::ranges::none_of(stars_.of(first), [&](std::uint32_t corner) {
               const Triangle& other = corners_[corner / 3];
               return std::ranges::find(other, second) != other.end() &&
                      (gone_[corner / 3] || std::ranges::find(other, third) != other.end());
           });
}

bool FaceAnglePass::closeHole(std::uint32_t vertex, Patch& patch) {
    if (!makeFan(surface_, corners_, stars_.of(vertex), fan_) || !isStraight(vertex))
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
    }
    for (const auto& [a, b] : patch.edges)
        new_edges_.insert(a, b);
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
    Patch patch;
    for (std::uint32_t v = 0; v < kept_.size() && !stopsAt(v, job); ++v) {
        if (!look[v] || kept_[v] || !(decided ? (*decided)[v] : isFlat(v)))
            continue;
        patch.clear();
        if (!closeHole(v, patch) || !isNew(patch))
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
        const FaceAnglePass pass(surface, options, job);
        decided.resize(surface.positions.size());
        for (std::uint32_t v = 0; v < decided.size() && !stopsAt(v, job); ++v)
            decided[v] = pass.isFlat(v);
    }
    std::vector<bool> look(surface.positions.size(), true);
    for (std::uint32_t p = 0; p < options.passes && !job.stopRequested(); ++p) {
        FaceAnglePass pass(surface, options, job);
        if (pass.run(look, decided.empty() ? nullptr : &decided, job) == 0)
            break;
        look = pass.takeNeighbours();
        keepFaces(surface, [&](std::size_t f) { return surface.faces[f][0] != kNone; });
        forgetUnusedWedges(surface);
    }
}

} // namespace lodestone
