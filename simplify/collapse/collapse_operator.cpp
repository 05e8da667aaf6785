// The edge-collapse operator: what may collapse, what dies, what is logged.
#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lodestone {

// Whether two faces on an edge lie back to back now.
bool ComponentMesh::folded(std::uint32_t face_a, std::uint32_t face_b) const {
    const Float3 m = faceNormal(faces_[face_a]);
    const Float3 n = faceNormal(faces_[face_b]);
    const float product = dot(m, m) * dot(n, n);
    return product > 0.0f && dot(m, n) < kBackToBack * std::sqrt(product);
}

// Sorts the faces around both ends of an edge: those with one end, and those that would die.
void ComponentMesh::gatherRings(std::uint32_t a, std::uint32_t b) {
    ring_a_.clear();
    ring_b_.clear();
    dying_.clear();
    const auto gather = [&](std::uint32_t v, std::uint32_t other, std::vector<RingFace>& ring) {
        for (const std::uint32_t f : facesAround(v)) {
            const Corners& face = faces_[f];
            const std::size_t k = face[0] == v ? 0 : face[1] == v ? 1 : 2;
            const std::uint32_t next = face[k == 2 ? 0 : k + 1];
            const std::uint32_t last = face[k == 0 ? 2 : k - 1];
            if (next != other && last != other)
                ring.push_back({f, next, last, {}});
            else if (v == a)
                dying_.push_back(f);
        }
    };
    gather(a, b, ring_a_);
    gather(b, a, ring_b_);
}

bool ComponentMesh::hasFace(std::span<const RingFace> ring,
                            std::uint32_t x,
                            std::uint32_t y) const {
    return std::ranges::any_of(ring, [&](const RingFace& face) {
        return (face.next == x && face.last == y) || (face.next == y && face.last == x);
    });
}

// The link condition (Dey et al. 1999): neighbours that both ends share must span a face with the
// edge, no two faces may fall onto each other, and two border vertices merge only along the border.
bool ComponentMesh::keepsTopology(std::uint32_t a, std::uint32_t b) {
    if (metrics_[a].boundary && metrics_[b].boundary && dying_.size() > 1 &&
        !(dying_.size() == 2 && folded(dying_[0], dying_[1])))
        return false;
    const std::uint32_t near_a = nextStamp();
    const std::uint32_t opposite = nextStamp();
    for (const RingFace& face : ring_a_)
        points_[face.next].mark = points_[face.last].mark = near_a;
    for (const std::uint32_t f : dying_)
        for (const std::uint32_t v : faces_[f])
            points_[v].mark = opposite;
    for (const RingFace& face : ring_b_) {
        const std::uint32_t next = points_[face.next].mark;
        const std::uint32_t last = points_[face.last].mark;
        if (next == near_a || last == near_a)
            return false;
        if (next == opposite && last == opposite && hasFace(ring_a_, face.next, face.last))
            return false;
    }
    return true;
}

// Whether no face of a ring turns by more than the flip angle when its vertex moves.
bool ComponentMesh::staysUpright(std::span<const RingFace> ring, Float3 to) const {
    for (const RingFace& face : ring) {
        const Float3 u = points_[face.next].position;
        const Float3 side = points_[face.last].position - u;
        const Float3 before = face.area;
        const Float3 after = cross(u - to, side);
        const float before2 = dot(before, before);
        if (!(before2 > 0.0f))
            continue;
        const float product = dot(before, after);
        const float limit = flip_cosine2_ * before2 * dot(after, after);
        // product >= cosine * |before| |after|, without the roots
        const bool upright = flip_sharp_ ? product > 0.0f && product * product >= limit
                                         : product >= 0.0f || product * product <= limit;
        if (!upright)
            return false;
    }
    return true;
}

// Moves a place of the merged vertex along the surface's normal towards where the collapse keeps
// the volume (Lindstrom and Turk 1998): planes alone put it outside of what is curved. All the way
// would overdo it next to vertices that still lie outside. at, half: from the edge's middle.
Float3 ComponentMesh::towardsVolume(std::uint32_t a, std::uint32_t b, Float3 at, Float3 half) {
    constexpr float kShare = 0.8f;
    const auto area_of = [&](std::span<RingFace> ring, Float3 from) {
        Float3 area;
        for (RingFace& face : ring) {
            const Float3 u = points_[face.next].position;
            face.area = cross(u - from, points_[face.last].position - u);
            area = area + face.area;
        }
        return area;
    };
    const Float3 area_a = area_of(ring_a_, points_[a].position);
    const Float3 area_b = area_of(ring_b_, points_[b].position);
    Float3 area = area_a + area_b;
    for (const std::uint32_t f : dying_)
        area = area + faceNormal(faces_[f]);
    const float missing = dot(area_b - area_a, half) - dot(area, at);
    const float area2 = dot(area, area);
    // Where sheets lie back to back the normal means nothing.
    const bool sound = missing * missing < area2 * dot(half, half);
    return sound ? at + area * (kShare * missing / area2) : at;
}

bool ComponentMesh::tryCollapse(std::uint32_t a,
                                std::uint32_t b,
                                const Placement& placement,
                                Strictness strictness) {
    const Float3 from_a = points_[a].position;
    const Float3 from_b = points_[b].position;
    const Float3 half = (from_b - from_a) * 0.5f;
    gatherRings(a, b);
    const Float3 at = towardsVolume(a, b, placement.at, half);
    const Float3 target = from_a + half + at;
    if (strictness != Strictness::Anything &&
        !(staysUpright(ring_a_, target) && staysUpright(ring_b_, target)))
        return false;
    if (strictness == Strictness::Manifold && !keepsTopology(a, b))
        return false;

    const Quadric merged = sum(translated(metrics_[a].quadric, target - from_a),
                               translated(metrics_[b].quadric, target - from_b));
    log_.cost.push_back(merged.c);
    log_.error2.push_back(merged.weight > 0.0f ? merged.c / merged.weight : 0.0f);
    metrics_[a].quadric = merged;
    metrics_[a].boundary |= metrics_[b].boundary;
    points_[a].position = target;
    ++rings_[a].version;
    ++rings_[b].version;
    mergeFaces(a, b);
    const float length2 = dot(half, half);
    const float along = length2 > 0.0f ? dot(at, half) / length2 : 0.0f;
    const float t = std::clamp(0.5f + 0.5f * along, 0.0f, 1.0f);
    if (face_wedges_.empty())
        mergeSingleWedges(a, b, t);
    else
        mergeWedges(a, b, t);
    return true;
}

// Every vertex is its own wedge.
void ComponentMesh::mergeSingleWedges(std::uint32_t a, std::uint32_t b, float t) {
    const std::uint32_t into = vertex_ids_[a];
    blendValues(into, vertex_ids_[b], t);
    killWedge(vertex_ids_[b], into);
    if (alive(a))
        addVersion(into, points_[a].position);
    else
        killWedge(into, kNone);
    for (const std::uint32_t f : dying_)
        for (const std::uint32_t v : faces_[f])
            if (!alive(v) && log_.wedge_death[vertex_ids_[v]] == kNone)
                killWedge(vertex_ids_[v], kNone);
}

void ComponentMesh::dropReference(std::uint32_t v, std::uint32_t face) {
    Ring& ring = rings_[v];
    const auto begin = refs_.begin() + ring.begin;
    const auto at = std::find(begin, begin + ring.count, face);
    assert(at != begin + ring.count);
    *at = *(begin + --ring.count);
}

void ComponentMesh::killFace(std::uint32_t face) {
    log_.face_death[face_ids_[face]] = step();
    --live_faces_;
}

// Faces on the edge die, b's others become a's.
void ComponentMesh::mergeFaces(std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t f : dying_) {
        killFace(f);
        for (const std::uint32_t v : faces_[f])
            if (v != a && v != b)
                dropReference(v, f);
    }
    Ring& kept = rings_[a];
    const auto count = static_cast<std::uint32_t>(ring_a_.size() + ring_b_.size());
    if (count > kept.capacity) {
        kept.begin = static_cast<std::uint32_t>(refs_.size());
        kept.capacity = count;
        refs_.resize(refs_.size() + count);
    }
    kept.count = count;
    rings_[b].count = 0;
    auto to = refs_.begin() + kept.begin;
    for (const RingFace& face : ring_a_)
        *to++ = face.face;
    for (const RingFace& face : ring_b_) {
        Corners& corners = faces_[face.face];
        corners[corners[0] == b ? 0 : corners[1] == b ? 1 : 2] = a;
        *to++ = face.face;
    }
}

void ComponentMesh::killWedge(std::uint32_t wedge, std::uint32_t parent) {
    log_.wedge_death[wedge] = step();
    log_.wedge_parent[wedge] = parent;
    log_.kill_order.push_back(wedge);
}

void ComponentMesh::releaseWedge(std::uint32_t wedge) {
    if (wedge_refs_[wedge] == 0 && log_.wedge_death[wedge] == kNone)
        killWedge(wedge, kNone);
}

void ComponentMesh::blendValues(std::uint32_t into, std::uint32_t from, float t) {
    if (attributes_.carries && t > 0.5f)
        wedge_carrier_[into] = wedge_carrier_[from];
    if (attributes_.size == 0)
        return;
    float* to = values_.data() + std::size_t{into} * attributes_.size;
    const float* other = values_.data() + std::size_t{from} * attributes_.size;
    constexpr float kOpposite2 = 1e-6f; // opposite directions cancel: then the first one stays
    for (const WedgeAttributes::Slot& slot : attributes_.slots[wedge_primitive_[into]]) {
        const std::uint32_t blended = slot.tangent ? 3 : slot.components;
        float length2 = 0.0f;
        for (std::uint32_t c = slot.offset; c < slot.offset + blended; ++c) {
            const float value = to[c] + (other[c] - to[c]) * t;
            length2 += value * value;
        }
        if (slot.unit && !(length2 > kOpposite2))
            continue;
        const float scale = slot.unit ? 1.0f / std::sqrt(length2) : 1.0f;
        for (std::uint32_t c = slot.offset; c < slot.offset + blended; ++c)
            to[c] = (to[c] + (other[c] - to[c]) * t) * scale;
        if (slot.tangent && slot.components == 4 && t > 0.5f)
            to[slot.offset + 3] = other[slot.offset + 3];
    }
}

// Wedges that meet in a face on the edge become one; the others of b move to a as they are, so that
// seams stay seams and no crack opens.
void ComponentMesh::mergeWedges(std::uint32_t a, std::uint32_t b, float t) {
    std::vector<std::uint32_t>& touched = scratch_;
    touched.clear();
    merged_wedges_.clear();
    for (const std::uint32_t f : dying_) {
        std::uint32_t wedge_a = kNone;
        std::uint32_t wedge_b = kNone;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t wedge = face_wedges_[f][k];
            --wedge_refs_[wedge];
            touched.push_back(wedge);
            if (faces_[f][k] == a)
                wedge_a = wedge;
            else if (faces_[f][k] == b)
                wedge_b = wedge;
        }
        merged_wedges_.push_back({wedge_b, wedge_a});
    }
    for (const auto& [from, into] : merged_wedges_) {
        if (log_.wedge_death[from] != kNone) // merged through the other face on the edge already
            continue;
        blendValues(into, from, t);
        wedge_refs_[into] += wedge_refs_[from];
        wedge_refs_[from] = 0;
        killWedge(from, into);
    }
    for (const std::uint32_t f : facesAround(a)) {
        const std::size_t k = faces_[f][0] == a ? 0 : faces_[f][1] == a ? 1 : 2;
        std::uint32_t& wedge = face_wedges_[f][k];
        for (const auto& [from, into] : merged_wedges_)
            if (wedge == from && log_.wedge_parent[from] != kNone) {
                wedge = log_.wedge_parent[from];
                break;
            }
        touched.push_back(wedge);
    }
    std::ranges::sort(touched);
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const std::uint32_t wedge : touched)
        releaseWedge(wedge);
    for (const std::uint32_t f : facesAround(a)) {
        const std::size_t k = faces_[f][0] == a ? 0 : faces_[f][1] == a ? 1 : 2;
        const std::uint32_t wedge = face_wedges_[f][k];
        // The first corner with it adds the version: wedges in order of faces, each once.
        const bool seen = !log_.version_wedge.empty() && [&] {
            for (std::size_t i = log_.version_wedge.size(); i-- > 0;) {
                if (log_.version_step[i] != step())
                    return false;
                if (log_.version_wedge[i] == wedge)
                    return true;
            }
            return false;
        }();
        if (!seen)
            addVersion(wedge, points_[a].position);
    }
}

void ComponentMesh::addVersion(std::uint32_t wedge, Float3 position) {
    const glm::dvec3 p(position.x, position.y, position.z);
    log_.version_wedge.push_back(wedge);
    log_.version_step.push_back(step());
    log_.version_position.emplace_back(origin_ + p * scale_);
    if (attributes_.carries)
        log_.version_carrier.push_back(wedge_carrier_[wedge]);
    const auto from =
        values_.begin() + static_cast<std::ptrdiff_t>(std::size_t{wedge} * attributes_.size);
    log_.version_values.insert(log_.version_values.end(), from, from + attributes_.size);
}

} // namespace lodestone
