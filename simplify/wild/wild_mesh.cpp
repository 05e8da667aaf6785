#include "simplify/wild/wild_mesh.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

namespace {

// Unit direction in which the third corner of a face lies off one of its edges; a sliver's lies
// nowhere.
Float3 offEdge(Float3 along, Float3 to_third) {
    const float length2 = dot(along, along);
    if (!(length2 > 0.0f))
        return {};
    const Float3 off = to_third - along * (dot(to_third, along) / length2);
    const float off2 = dot(off, off);
    return off2 > 1e-12f * length2 ? off * (1.0f / std::sqrt(off2)) : Float3{};
}

} // namespace

WildMesh::WildMesh(const Complex& complex,
                   const InstanceWeights& weights,
                   const WedgeAttributes& attributes,
                   const CollapseOptions& options,
                   const WildOptions& wild)
    : ComponentMesh(complex, weights, attributes, options), wild_(wild),
      border_metric_(weights.area()) {}

void WildMesh::load(std::size_t component) {
    ComponentMesh::load(component);
    component_ = component;
    areas_.assign(vertexCount(), {});
}

std::vector<WildMesh::Edge> WildMesh::edges() {
    std::vector<Edge> all;
    face_edges_.assign(faces_.size(), {kNone, kNone, kNone});
    for (std::uint32_t v = 0; v < vertexCount(); ++v) {
        const std::uint32_t stamp = nextStamp();
        for (const std::uint32_t face : facesAround(v)) {
            const Corners& corners = faces_[face];
            const std::size_t at = cornerOf(corners, v);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t other = corners[k];
                if (other <= v)
                    continue;
                if (points_[other].mark != stamp) {
                    points_[other].mark = stamp;
                    mark_face_[other] = static_cast<std::uint32_t>(all.size());
                    all.push_back({v, other});
                }
                face_edges_[face][3 - at - k] = mark_face_[other];
            }
        }
    }
    if (complex_.virtual_edges.empty())
        return all;
    for (std::size_t f = 0; f < faces_.size(); ++f)
        for (std::size_t k = 0; k < 3; ++k)
            local_of_vertex_[complex_.wedge_vertex[log_.wedges[face_wedges_[f][k]]]] = faces_[f][k];
    for (std::uint32_t e = complex_.virtual_begin[component_];
         e < complex_.virtual_begin[component_ + 1];
         ++e)
        all.push_back({local_of_vertex_[complex_.virtual_edges[e][0]],
                       local_of_vertex_[complex_.virtual_edges[e][1]]});
    for (const std::uint32_t wedge : log_.wedges)
        local_of_vertex_[complex_.wedge_vertex[wedge]] = kNone;
    return all;
}

// For every edge at a vertex, on which sides its faces lie.
void WildMesh::gatherSides(std::uint32_t v) {
    sides_.clear();
    const std::uint32_t stamp = nextStamp();
    const Float3 from = points_[v].position;
    const auto add = [&](std::uint32_t other, Float3 along, Float3 to_third) {
        if (points_[other].mark != stamp) {
            points_[other].mark = stamp;
            mark_face_[other] = static_cast<std::uint32_t>(sides_.size());
            sides_.push_back({other, 1, along, {to_third, {}}, {}});
            return;
        }
        Side& side = sides_[mark_face_[other]];
        if (++side.faces == 2) {
            side.thirds[1] = to_third;
            return;
        }
        if (side.faces == 3)
            side.sum = offEdge(along, side.thirds[0]) + offEdge(along, side.thirds[1]);
        side.sum = side.sum + offEdge(along, to_third);
    };
    for (const std::uint32_t face : facesAround(v)) {
        const Corners& corners = faces_[face];
        const std::size_t k = cornerOf(corners, v);
        const std::uint32_t next = corners[(k + 1) % 3];
        const std::uint32_t last = corners[(k + 2) % 3];
        const Float3 to_next = points_[next].position - from;
        const Float3 to_last = points_[last].position - from;
        add(next, to_next, to_last);
        add(last, to_last, to_next);
    }
}

// Borders are edges all of whose faces lie on the same side: with one face, or with several that
// lie back to back (the rims of two-sided cards, and of sheets that have merged).
bool WildMesh::isBorder(const Side& side) {
    constexpr float kSameSide = 0.99f;
    Float3 sum = side.sum;
    if (side.faces < 3) {
        const auto& [one, two] = side.thirds;
        if (side.faces == 2 && dot(one, two) * dot(side.along, side.along) <=
                                   dot(one, side.along) * dot(two, side.along))
            return false; // on opposite sides: nearly always
        sum = offEdge(side.along, one);
        if (side.faces == 2)
            sum = sum + offEdge(side.along, two);
    }
    const float least = kSameSide * static_cast<float>(side.faces);
    return dot(sum, sum) > least * least;
}

void WildMesh::addBorder(Area& area, Float3 edge) const {
    const glm::dvec3 e(edge.x, edge.y, edge.z);
    const glm::dmat3 turn(0.0, e.z, -e.y, -e.z, 0.0, e.x, e.y, -e.x, 0.0); // turn * x = e cross x
    const glm::dmat3 swept = glm::transpose(turn) * border_metric_ * turn;
    area.xx += static_cast<float>(swept[0][0]);
    area.yy += static_cast<float>(swept[1][1]);
    area.zz += static_cast<float>(swept[2][2]);
    area.xy += static_cast<float>(swept[1][0]);
    area.xz += static_cast<float>(swept[2][0]);
    area.yz += static_cast<float>(swept[2][1]);
    area.weight += dot(edge, edge);
}

const WildMesh::Area& WildMesh::areaOf(std::uint32_t v) {
    Area& area = areas_[v];
    if (!area.stale)
        return area;
    area = {};
    area.stale = false;
    gatherSides(v);
    for (const Side& side : sides_)
        if (isBorder(side))
            addBorder(area, side.along);
    return area;
}

Quadric WildMesh::areaQuadric(std::uint32_t v) {
    const Area& area = areaOf(v);
    const auto w = static_cast<float>(wild_.area_weight);
    Quadric q;
    q.xx = area.xx * w;
    q.yy = area.yy * w;
    q.zz = area.zz * w;
    q.xy = area.xy * w;
    q.xz = area.xz * w;
    q.yz = area.yz * w;
    q.weight = area.weight * w;
    return q;
}

float WildMesh::longestEdge2(std::uint32_t v) const {
    float longest = 0.0f;
    for (const std::uint32_t face : facesAround(v))
        for (const std::uint32_t other : faces_[face]) {
            const Float3 edge = points_[other].position - points_[v].position;
            longest = std::max(longest, dot(edge, edge));
        }
    return longest;
}

namespace {

// Minimum of a quadric that is positive definite. Result: false if it is not, to working precision.
bool minimumOf(const Quadric& s, Float3& at) {
    const double trace = double{s.xx} + s.yy + s.zz;
    const double least = 1e-7 * trace;
    const double d0 = s.xx;
    if (!(d0 > least))
        return false;
    const double l10 = s.xy / d0;
    const double l20 = s.xz / d0;
    const double d1 = s.yy - l10 * s.xy;
    if (!(d1 > least))
        return false;
    const double m21 = s.yz - l20 * s.xy;
    const double l21 = m21 / d1;
    const double d2 = s.zz - l20 * s.xz - l21 * m21;
    if (!(d2 > least))
        return false;
    const double y0 = -s.bx;
    const double y1 = -s.by - l10 * y0;
    const double y2 = -s.bz - l20 * y0 - l21 * y1;
    const double z = y2 / d2;
    const double y = y1 / d1 - l21 * z;
    const double x = y0 / d0 - l10 * y - l20 * z;
    at = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    return true;
}

// Determinant over that of a ball of the same trace: 1 where all directions count alike.
float roundness(const Quadric& s) {
    const float third = (s.xx + s.yy + s.zz) / 3.0f;
    const float determinant = s.xx * (s.yy * s.zz - s.yz * s.yz) -
                              s.xy * (s.xy * s.zz - s.yz * s.xz) +
                              s.xz * (s.xy * s.yz - s.yy * s.xz);
    return third > 0.0f ? determinant / (third * third * third) : 0.0f;
}

} // namespace

// Where planes and borders leave the place open, each end's faces are taken as samples of noisy
// ones (Trettner and Kobbelt 2020): normals of deviation sigma about points at the end, which adds
// sigma^2 times the area times the squared distance to the end. A solution farther out than the
// longest edge around falls back to the best of both ends and the middle.
Placement WildMesh::place(std::uint32_t a, std::uint32_t b) {
    constexpr float kRound = 1e-2f;
    constexpr float kSigma2 = 1e-4f;
    constexpr float kForgiven = 0.4f;
    constexpr float kShortEdge = 1e-7f;
    const Float3 half = (points_[b].position - points_[a].position) * 0.5f;
    const Quadric& planes_a = metrics_[a].quadric;
    const Quadric& planes_b = metrics_[b].quadric;
    const Quadric exact =
        sumAtMiddle(sum(planes_a, areaQuadric(a)), sum(planes_b, areaQuadric(b)), half);
    Quadric solved = exact;
    if (roundness(exact) < kRound) {
        const float noise_a = kSigma2 * planes_a.weight;
        const float noise_b = kSigma2 * planes_b.weight;
        solved.xx += noise_a + noise_b;
        solved.yy += noise_a + noise_b;
        solved.zz += noise_a + noise_b;
        const Float3 pull = half * (noise_a - noise_b); // ends lie at -half and +half
        solved.bx += pull.x;
        solved.by += pull.y;
        solved.bz += pull.z;
    }
    Placement best{{}, std::max(exact.c, 0.0f), 0.0f};
    Float3 x;
    const float length2 = dot(half, half);
    const bool found = minimumOf(solved, x);
    const float reach2 = dot(x, x);
    if (found &&
        (reach2 <= 4.0f * length2 || reach2 <= std::max(longestEdge2(a), longestEdge2(b)))) {
        best = {x, std::max(evaluate(exact, x), 0.0f), 0.0f};
    } else {
        for (const float side : {1.0f, -1.0f})
            if (const float cost = evaluate(exact, half * side); cost < best.cost)
                best = {half * side, std::max(cost, 0.0f), 0.0f};
    }
    const float added = best.cost - (planes_a.c + planes_b.c) * kForgiven;
    best.key = (added > 0.0f ? added * dearness(a, b) : 0.0f) +
               (exact.xx + exact.yy + exact.zz) * length2 * kShortEdge;
    return best;
}

// What the queue multiplies an edge's cost by: cost per face removed, over that of an inner edge.
// Across a gap nothing is removed, and what it does to borders is forgotten at once: merging must
// be nearly free, or it wears cards down without any gain (an oak at 10 %: mean 0.56 % without the
// factor, 0.27 % with it).
float WildMesh::dearness(std::uint32_t a, std::uint32_t b) const {
    constexpr float kBorder = 2.0f;
    constexpr float kGap = 30.0f;
    const std::uint32_t fewer = valence(a) < valence(b) ? a : b;
    const std::uint32_t other = fewer == a ? b : a;
    const auto shared = std::ranges::count_if(facesAround(fewer), [&](std::uint32_t face) {
        return std::ranges::find(faces_[face], other) != faces_[face].end();
    });
    return shared == 0 ? kGap : shared == 1 ? kBorder : 1.0f;
}

bool WildMesh::twoSided(std::uint32_t face) const {
    const std::size_t primitive = complex_.primitiveOfFace(log_.faces[face_ids_[face]]);
    return primitive < wild_.two_sided.size() && wild_.two_sided[primitive];
}

// Whether a face around b falls onto one around a.
bool WildMesh::isDouble(const RingFace& face) const {
    return std::ranges::any_of(ring_a_, [&](const RingFace& other) {
        if (other.next == face.next && other.last == face.last)
            return true;
        return other.next == face.last && other.last == face.next &&
               (twoSided(face.face) || twoSided(other.face));
    });
}

// Of faces that fall onto each other one stays.
void WildMesh::dropDoubles() {
    const std::uint32_t near_a = nextStamp();
    for (const RingFace& face : ring_a_)
        points_[face.next].mark = points_[face.last].mark = near_a;
    const auto is_dropped = [&](const RingFace& face) {
        if (points_[face.next].mark != near_a || points_[face.last].mark != near_a ||
            !isDouble(face))
            return false;
        dying_.push_back(face.face);
        return true;
    };
    const auto kept_end = std::remove_if(ring_b_.begin(), ring_b_.end(), is_dropped);
    ring_b_ = ring_b_.first(static_cast<std::size_t>(kept_end - ring_b_.begin()));
}

// Borders near a collapse have changed: those of its neighbours are reckoned anew when needed.
void WildMesh::touchAround(std::uint32_t a, std::span<const std::uint32_t> dead) {
    const auto touch = [&](std::uint32_t face) {
        for (const std::uint32_t v : faces_[face]) {
            Area& area = areas_[v];
            if (v != a && !area.stale && area.weight > 0.0f)
                ++rings_[v].version;
            area.stale = true;
        }
    };
    std::ranges::for_each(facesAround(a), touch);
    std::ranges::for_each(dead, touch);
}

bool WildMesh::collapse(std::uint32_t a, std::uint32_t b, Strictness strictness) {
    const Placement placement = place(a, b);
    const Float3 from_a = points_[a].position;
    const Float3 from_b = points_[b].position;
    const Float3 half = (from_b - from_a) * 0.5f;
    gatherRings(a, b);
    // Volume means something where topology does; towardsVolume() also readies what the next check
    // needs.
    const Float3 at =
        strictness == Strictness::Anything ? placement.at : towardsVolume(a, b, placement.at, half);
    const Float3 target = from_a + half + at;
    if (strictness != Strictness::Anything && !staysUpright(target))
        return false;
    if (strictness == Strictness::Manifold && !keepsTopology(a, b))
        return false;
    dropDoubles();
    const Quadric swept = sumAtMiddle(areaQuadric(a), areaQuadric(b), half);
    const float area_cost = std::max(evaluate(swept, at), 0.0f);
    const Quadric merged = sum(translated(metrics_[a].quadric, target - from_a),
                               translated(metrics_[b].quadric, target - from_b));
    const float to_planes = merged.weight > 0.0f ? merged.c / merged.weight : 0.0f;
    const float to_borders = swept.weight > 0.0f ? area_cost / swept.weight : 0.0f;
    pairWedges(a, b);
    merge(a, b, target, merged, {merged.c + area_cost, std::max(to_planes, to_borders)});
    touchAround(a, dying_);
    return true;
}

} // namespace lodestone
