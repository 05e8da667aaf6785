#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

namespace lodestone {

ComponentMesh::ComponentMesh(const Complex& complex,
                             const InstanceWeights& weights,
                             const WedgeAttributes& attributes,
                             const CollapseOptions& options)
    : complex_(complex), weights_(weights), attributes_(attributes), options_(options),
      local_of_vertex_(complex.positions.size(), kNone),
      local_of_wedge_(complex.wedge_source.size(), kNone) {
    const double cosine = std::cos(options.flip_angle_deg * std::numbers::pi / 180.0);
    flip_cosine2_ = static_cast<float>(cosine * cosine);
    flip_sharp_ = cosine > 0.0;
}

void ComponentMesh::load(std::size_t component) {
    log_ = {};
    values_.clear();
    buildVertices(component);
    const std::size_t steps = points_.size(); // at most: every step ends a vertex
    log_.cost.reserve(steps);
    log_.error2.reserve(steps);
    log_.kill_order.reserve(log_.wedges.size());
    log_.version_wedge.reserve(steps);
    log_.version_step.reserve(steps);
    log_.version_position.reserve(steps);
    buildReferences();
    buildWedges();
    buildQuadrics();
    chooseValues();
    if (wedge_quadrics_.active())
        buildWedgeQuadrics();
}

void ComponentMesh::buildVertices(std::size_t component) {
    const std::uint32_t begin = complex_.component_begin[component];
    const std::uint32_t end = complex_.component_begin[component + 1];
    faces_.resize(end - begin);
    face_wedges_.resize(end - begin);
    log_.faces.assign(complex_.component_faces.begin() + begin,
                      complex_.component_faces.begin() + end);
    std::vector<std::uint32_t>& ids = scratch_; // complex vertex of each local one
    ids.clear();
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t wedge = complex_.faces[log_.faces[f]][k];
            const std::uint32_t vertex = complex_.wedge_vertex[wedge];
            if (local_of_vertex_[vertex] == kNone) {
                local_of_vertex_[vertex] = static_cast<std::uint32_t>(ids.size());
                ids.push_back(vertex);
            }
            if (local_of_wedge_[wedge] == kNone) {
                local_of_wedge_[wedge] = static_cast<std::uint32_t>(log_.wedges.size());
                log_.wedges.push_back(wedge);
            }
            faces_[f][k] = local_of_vertex_[vertex];
            face_wedges_[f][k] = local_of_wedge_[wedge];
        }
    placeVertices(ids);
    for (const std::uint32_t id : ids)
        local_of_vertex_[id] = kNone;
    for (const std::uint32_t wedge : log_.wedges)
        local_of_wedge_[wedge] = kNone;
}

// Origin, scale and positions. Vertices absurdly far out do not set the scale: they are locked and
// reckoned with as if they lay a few sizes away.
void ComponentMesh::placeVertices(std::span<const std::uint32_t> ids) {
    constexpr double kRim = 4.0;
    Bounds bounds;
    Bounds bulk;
    for (const std::uint32_t id : ids) {
        const glm::dvec3 p(complex_.positions[id]);
        bounds.add(p);
        if (complex_.bulk.holds(p))
            bulk.add(p);
    }
    if (bulk.diagonal() > 0.0)
        bounds = bulk;
    origin_ = bounds.center();
    scale_ = bounds.diagonal() > 0.0 ? bounds.diagonal() : 1.0;
    points_.assign(ids.size(), {});
    metrics_.assign(ids.size(), {});
    for (std::size_t v = 0; v < ids.size(); ++v) {
        glm::dvec3 p = (glm::dvec3(complex_.positions[ids[v]]) - origin_) / scale_;
        if (const double distance = glm::length(p); distance > kRim) { // never inside the bounds
            p *= kRim / distance;
            metrics_[v].locked = true;
        }
        metrics_[v].extreme = std::ranges::binary_search(attributes_.extremes, ids[v]);
        points_[v].position = {
            static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    }
}

void ComponentMesh::buildReferences() {
    live_faces_ = static_cast<std::uint32_t>(faces_.size());
    log_.face_death.assign(faces_.size(), kNone);
    face_ids_.resize(faces_.size());
    std::iota(face_ids_.begin(), face_ids_.end(), 0u);
    rings_.assign(points_.size(), {});
    fillRings();
    mark_face_.resize(points_.size());
    stamp_ = 0;
}

// Lists the faces around each vertex anew; versions are kept.
void ComponentMesh::fillRings() {
    for (Ring& ring : rings_)
        ring.capacity = ring.count = 0;
    for (const Corners& face : faces_)
        for (const std::uint32_t v : face)
            ++rings_[v].capacity;
    std::uint32_t at = 0;
    for (Ring& ring : rings_) {
        ring.begin = at;
        at += ring.capacity;
    }
    refs_.resize(at);
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
        for (const std::uint32_t v : faces_[f])
            refs_[rings_[v].begin + rings_[v].count++] = f;
}

void ComponentMesh::buildWedges() {
    const std::size_t wedges = log_.wedges.size();
    log_.wedge_death.assign(wedges, kNone);
    log_.wedge_parent.assign(wedges, kNone);
    vertex_ids_.clear();
    wedge_refs_.clear();
    wedge_counts_.clear();
    gatherValues();
    // One each, and numbered alike: both by first use. Virtual edges may join two on one vertex.
    if (wedges == points_.size() && complex_.virtual_edges.empty()) {
        face_wedges_.clear();
        vertex_ids_.resize(wedges);
        std::iota(vertex_ids_.begin(), vertex_ids_.end(), 0u);
        return;
    }
    wedge_refs_.assign(wedges, 0);
    for (const Corners& corners : face_wedges_)
        for (const std::uint32_t wedge : corners)
            ++wedge_refs_[wedge];
    if (options_.seams >= 1.0)
        return;
    wedge_counts_.assign(points_.size(), 0);
    std::vector<bool> counted(wedges, false);
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            if (!counted[face_wedges_[f][k]]) {
                counted[face_wedges_[f][k]] = true;
                ++wedge_counts_[faces_[f][k]];
            }
}

// Attributes of the component's wedges, and which primitive says what they are.
void ComponentMesh::gatherValues() {
    const std::size_t wedges = log_.wedges.size();
    wedge_primitive_.assign(wedges, 0);
    if (complex_.face_begin.size() > 2)
        for (std::uint32_t f = 0; f < faces_.size(); ++f) {
            const std::size_t primitive = complex_.primitiveOfFace(log_.faces[f]);
            for (const std::uint32_t wedge : face_wedges_[f])
                wedge_primitive_[wedge] = static_cast<std::uint32_t>(primitive);
        }
    wedge_carrier_.resize(attributes_.carries ? wedges : 0);
    std::iota(wedge_carrier_.begin(), wedge_carrier_.end(), 0u);
    values_.resize(wedges * attributes_.size);
    for (std::size_t w = 0; w < wedges; ++w) {
        const std::size_t from = std::size_t{log_.wedges[w]} * attributes_.size;
        std::copy_n(attributes_.values.begin() + static_cast<std::ptrdiff_t>(from),
                    attributes_.size,
                    values_.begin() + static_cast<std::ptrdiff_t>(w * attributes_.size));
    }
}

std::span<const std::uint32_t> ComponentMesh::compact() {
    if (std::size_t{2} * live_faces_ > faces_.size())
        return {};
    moved_to_.assign(points_.size(), kNone);
    std::uint32_t vertices = 0;
    for (std::uint32_t v = 0; v < points_.size(); ++v) {
        if (!alive(v))
            continue;
        moved_to_[v] = vertices;
        points_[vertices] = points_[v];
        metrics_[vertices] = metrics_[v];
        if (!shapes_.empty())
            shapes_[vertices] = shapes_[v];
        if (!wedge_counts_.empty())
            wedge_counts_[vertices] = wedge_counts_[v];
        rings_[vertices] = rings_[v];
        if (!vertex_ids_.empty())
            vertex_ids_[vertices] = vertex_ids_[v];
        ++vertices;
    }
    points_.resize(vertices);
    metrics_.resize(vertices);
    rings_.resize(vertices);
    std::uint32_t faces = 0;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        if (log_.face_death[face_ids_[f]] != kNone)
            continue;
        for (std::size_t k = 0; k < 3; ++k)
            faces_[faces][k] = moved_to_[faces_[f][k]];
        if (!face_wedges_.empty())
            face_wedges_[faces] = face_wedges_[f];
        face_ids_[faces++] = face_ids_[f];
    }
    faces_.resize(faces);
    face_ids_.resize(faces);
    if (!face_wedges_.empty())
        face_wedges_.resize(faces);
    fillRings();
    return moved_to_;
}

Float3 ComponentMesh::faceNormal(const Corners& face) const {
    const Float3 a = points_[face[0]].position;
    return cross(points_[face[1]].position - a, points_[face[2]].position - a);
}

void ComponentMesh::buildQuadrics() {
    normals_.resize(faces_.size());
    face_weights_.resize(faces_.size());
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
        addFaceQuadric(f);
    for (std::uint32_t v = 0; v < points_.size(); ++v)
        addBoundaryQuadrics(v);
    if (!attributes_.extremes.empty())
        holdExtremes();
}

// The ends of limbs, on which the box of a moving submesh rests: leaving its place costs such a
// vertex as much as the whole surface off by as far.
void ComponentMesh::holdExtremes() {
    double area = 0.0;
    double weighted = 0.0; // by instances
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        const Float3 normal = faceNormal(faces_[f]);
        area += face_weights_[f] > 0.0f ? 0.5 * std::sqrt(double{dot(normal, normal)}) : 0.0;
        weighted += double{face_weights_[f]};
    }
    if (!(area > 0.0))
        return;
    const auto weight =
        static_cast<float>(attributes_.area / (scale_ * scale_) * (weighted / area));
    for (Metric& metric : metrics_)
        if (metric.extreme && !metric.locked) {
            metric.quadric.xx += weight;
            metric.quadric.yy += weight;
            metric.quadric.zz += weight;
        }
}

float ComponentMesh::faceWeight(std::uint32_t face, float area) const {
    const Corners& corners = faces_[face];
    const bool out = metrics_[corners[0]].locked || metrics_[corners[1]].locked ||
                     metrics_[corners[2]].locked; // then its area means nothing
    if (out || !(area > 0.0f))
        return 0.0f;
    const Float3 unit = normals_[face];
    return weights_.uniform() ? area
                              : area * static_cast<float>(weights_.face({unit.x, unit.y, unit.z}));
}

void ComponentMesh::addFaceQuadric(std::uint32_t face) {
    const Float3 normal = faceNormal(faces_[face]);
    const float length = std::sqrt(dot(normal, normal));
    normals_[face] = length > 0.0f ? normal * (1.0f / length) : Float3{};
    Quadric quadric;
    quadric.weight = face_weights_[face] = faceWeight(face, 0.5f * length);
    if (!(quadric.weight > 0.0f))
        return;
    addSquare(quadric, normals_[face], 0.0f, quadric.weight); // through its corners: offset 0
    for (const std::uint32_t v : faces_[face])
        metrics_[v].quadric = sum(metrics_[v].quadric, quadric);
}

// Whether the material, a texture coordinate or a colour changes across the edge of two faces.
// Normals do not count: where they change, the planes of the faces do too.
bool ComponentMesh::seamBetween(std::uint32_t face_a,
                                std::uint32_t face_b,
                                std::uint32_t vertex) const {
    if (face_wedges_.empty())
        return false;
    const std::uint32_t m = wedgeAt(face_a, vertex);
    const std::uint32_t n = wedgeAt(face_b, vertex);
    if (m == n)
        return false;
    if (wedge_primitive_[m] != wedge_primitive_[n])
        return true;
    const auto differs = [&](const WedgeAttributes::Slot& slot) {
        const auto at = [&](std::uint32_t wedge) {
            return values_.begin() +
                   static_cast<std::ptrdiff_t>(std::size_t{wedge} * attributes_.size + slot.offset);
        };
        const bool shows = slot.kind == WedgeAttributes::Kind::Texcoord ||
                           slot.kind == WedgeAttributes::Kind::Color;
        return shows && !std::equal(at(m), at(m) + slot.components, at(n));
    };
    return std::ranges::any_of(attributes_.primitives[wedge_primitive_[m]].slots, differs);
}

// Whether the faces around a vertex are one closed fan that does not fold back: no border then.
bool ComponentMesh::closesFan(std::uint32_t a) {
    const std::uint32_t stamp = nextStamp();
    for (const std::uint32_t face : facesAround(a)) {
        const std::uint32_t next = faces_[face][kNext[cornerOf(faces_[face], a)]];
        points_[next].mark = stamp;
        mark_face_[next] = face;
    }
    bool closed = true;
    for (const std::uint32_t face : facesAround(a)) {
        const std::uint32_t last = faces_[face][kLast[cornerOf(faces_[face], a)]];
        closed &= points_[last].mark == stamp;
        points_[last].mark = 0; // once
        const std::uint32_t beside = closed ? mark_face_[last] : face;
        closed &= !(dot(normals_[face], normals_[beside]) < kBackToBack);
    }
    return closed;
}

// Borders: edges with one face, or with two that lie back to back. Seams get the same constraint,
// so that a flat chequerboard keeps its squares, but may collapse like inner edges.
void ComponentMesh::addBoundaryQuadrics(std::uint32_t a) {
    const bool has_outline = options_.silhouette_weight > 0.0;
    if (!has_outline && face_wedges_.empty() && closesFan(a)) // no seam either
        return;
    const std::uint32_t border = nextStamp();
    const std::uint32_t inner = nextStamp();
    std::uint32_t borders = 0;
    for (const std::uint32_t face : facesAround(a))
        for (const std::uint32_t b : faces_[face]) {
            if (b <= a) // each edge once
                continue;
            if (points_[b].mark < border) {
                points_[b].mark = border;
                mark_face_[b] = face;
                ++borders;
                continue;
            }
            const std::uint32_t first = mark_face_[b];
            if (points_[b].mark == inner || dot(normals_[first], normals_[face]) < kBackToBack)
                continue;
            points_[b].mark = inner;
            --borders;
            if (seamBetween(first, face, a) || seamBetween(first, face, b)) {
                const bool has_plane = dot(normals_[first], normals_[first]) > 0.0f;
                addBoundaryQuadric(a, b, has_plane ? first : face); // a sliver that sews has none
            }
            if (has_outline)
                addSilhouetteQuadric(a, b, normals_[first], normals_[face]);
        }
    if (borders == 0)
        return;
    for (const std::uint32_t face : facesAround(a))
        for (const std::uint32_t b : faces_[face])
            if (b > a && points_[b].mark == border) {
                addBoundaryQuadric(a, b, mark_face_[b]);
                metrics_[a].boundary = metrics_[b].boundary = true;
                points_[b].mark = inner; // once
            }
}

void ComponentMesh::addBoundaryQuadric(std::uint32_t a, std::uint32_t b, std::uint32_t face) {
    const Float3 edge = points_[b].position - points_[a].position;
    const Float3 normal = normals_[face];
    const float length2 = dot(edge, edge);
    if (!(dot(normal, normal) > 0.0f) || !(length2 > 0.0f))
        return;
    const auto add = [&](Float3 unit, double weight) {
        // By length the weight is a length, not an area: back to the scaled units' square.
        if (options_.boundary_by_length)
            weight /= scale_;
        const auto w = static_cast<float>(weight * options_.boundary_weight);
        addSquare(metrics_[a].quadric, unit, 0.0f, w);
        addSquare(metrics_[b].quadric, unit, 0.0f, w);
    };
    if (weights_.uniform() && !options_.boundary_by_length) {
        const Float3 across = cross(edge, normal);
        add(across * (1.0f / std::sqrt(dot(across, across))), length2);
        return;
    }
    std::vector<InstanceWeights::Plane> planes;
    weights_.border(glm::dvec3(edge.x, edge.y, edge.z),
                    glm::normalize(glm::dvec3(normal.x, normal.y, normal.z)),
                    options_.boundary_by_length,
                    planes);
    for (const InstanceWeights::Plane& plane : planes)
        add({static_cast<float>(plane.normal.x),
             static_cast<float>(plane.normal.y),
             static_cast<float>(plane.normal.z)},
            plane.weight);
}

// An edge is part of the outline for the share (angle between its faces) / pi of all directions;
// from there the outline's error is the distance along some u between the faces' normals. Summed
// over them, with m halfway and t across: integral of u u^T = (angle + sin) / 2 m m^T +
// (angle - sin) / 2 t t^T. Weighted by the squared length, as borders are.
void ComponentMesh::addSilhouetteQuadric(std::uint32_t a,
                                         std::uint32_t b,
                                         Float3 normal_a,
                                         Float3 normal_b) {
    const Float3 edge = points_[b].position - points_[a].position;
    const Float3 middle = normal_a + normal_b;
    const Float3 across = cross(edge, middle);
    const float middle2 = dot(middle, middle);
    const float across2 = dot(across, across);
    if (!(dot(normal_a, normal_a) > 0.0f) || !(dot(normal_b, normal_b) > 0.0f) ||
        !(middle2 > 1e-6f) || !(across2 > 0.0f))
        return;
    const float sine = std::sqrt(std::max(0.0f, 1.0f - 0.25f * middle2) * middle2);
    const float angle = std::acos(std::clamp(dot(normal_a, normal_b), -1.0f, 1.0f));
    constexpr float kFlat = 1e-3f; // what rounding makes of none
    if (angle < kFlat)
        return;
    const Float3 unit = middle * (1.0f / std::sqrt(middle2));
    const double instances = weights_.uniform() ? 1.0 : weights_.face({unit.x, unit.y, unit.z});
    const auto weight =
        static_cast<float>(options_.silhouette_weight * instances *
                           static_cast<double>(dot(edge, edge)) / (2.0 * std::numbers::pi));
    for (const std::uint32_t v : {a, b}) {
        addSquare(metrics_[v].quadric, unit, 0.0f, weight * (angle + sine));
        addSquare(metrics_[v].quadric,
                  across * (1.0f / std::sqrt(across2)),
                  0.0f,
                  weight * std::max(angle - sine, 0.0f));
    }
}

double ComponentMesh::costScale() const {
    return scale_ * scale_ * scale_ * scale_;
}

CollapseLog ComponentMesh::takeLog() {
    return std::move(log_);
}

} // namespace lodestone
