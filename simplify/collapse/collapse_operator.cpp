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

bool ComponentMesh::hasFace(std::uint32_t a, std::uint32_t x, std::uint32_t y) const {
    for (const std::uint32_t f : facesAround(a)) {
        const Corners& face = faces_[f];
        const bool has_x = face[0] == x || face[1] == x || face[2] == x;
        const bool has_y = face[0] == y || face[1] == y || face[2] == y;
        if (has_x && has_y)
            return true;
    }
    return false;
}

// The link condition (Dey et al. 1999): neighbours that both ends share must span a face with the
// edge, no two faces may fall onto each other, and two border vertices merge only along the border.
bool ComponentMesh::keepsTopology(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t near_a = nextStamp();
    const std::uint32_t opposite = nextStamp();
    std::uint32_t edge_faces = 0;
    std::array<std::uint32_t, 2> on_edge{kNone, kNone};
    for (const std::uint32_t f : facesAround(a)) {
        const Corners& face = faces_[f];
        const bool dies = face[0] == b || face[1] == b || face[2] == b;
        if (dies && edge_faces < 2)
            on_edge[edge_faces] = f;
        edge_faces += dies;
        for (const std::uint32_t v : face)
            if (dies)
                mark_[v] = opposite;
            else if (mark_[v] != opposite)
                mark_[v] = near_a;
    }
    if (vertices_[a].boundary && vertices_[b].boundary && edge_faces > 1 &&
        !(edge_faces == 2 && folded(on_edge[0], on_edge[1])))
        return false;
    for (const std::uint32_t f : facesAround(b)) {
        const Corners& face = faces_[f];
        if (face[0] == a || face[1] == a || face[2] == a)
            continue;
        std::array<std::uint32_t, 2> others;
        std::size_t found = 0;
        for (const std::uint32_t v : face)
            if (v != b)
                others[found++] = v;
        for (const std::uint32_t v : others)
            if (mark_[v] == near_a)
                return false;
        if (mark_[others[0]] == opposite && mark_[others[1]] == opposite &&
            hasFace(a, others[0], others[1]))
            return false;
    }
    return true;
}

bool ComponentMesh::facesStayUpright(std::uint32_t moved,
                                     std::uint32_t other,
                                     Float3 target) const {
    const Float3 origin = vertices_[moved].position;
    for (const std::uint32_t f : facesAround(moved)) {
        const Corners& face = faces_[f];
        if (face[0] == other || face[1] == other || face[2] == other)
            continue;
        const std::size_t k = face[0] == moved ? 0 : face[1] == moved ? 1 : 2;
        const Float3 u = vertices_[face[(k + 1) % 3]].position;
        const Float3 v = vertices_[face[(k + 2) % 3]].position;
        const Float3 side = v - u;
        const Float3 before = cross(u - origin, side);
        const Float3 after = cross(u - target, side);
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

bool ComponentMesh::keepsOrientation(std::uint32_t a, std::uint32_t b, Float3 target) const {
    return facesStayUpright(a, b, target) && facesStayUpright(b, a, target);
}

bool ComponentMesh::tryCollapse(std::uint32_t a,
                                std::uint32_t b,
                                const Placement& placement,
                                Strictness strictness) {
    Vertex& kept = vertices_[a];
    Vertex& gone = vertices_[b];
    const Float3 half = (gone.position - kept.position) * 0.5f;
    const Float3 target = kept.position + half + placement.at;
    if (strictness != Strictness::Anything && !keepsOrientation(a, b, target))
        return false;
    if (strictness == Strictness::Manifold && !keepsTopology(a, b))
        return false;

    const Quadric merged = sum(translated(kept.quadric, target - kept.position),
                               translated(gone.quadric, target - gone.position));
    log_.cost.push_back(placement.cost);
    log_.error2.push_back(merged.weight > 0.0f ? placement.cost / merged.weight : 0.0f);
    const float length2 = dot(half, half);
    const float t = length2 > 0.0f
                        ? std::clamp(0.5f + 0.5f * dot(placement.at, half) / length2, 0.0f, 1.0f)
                        : 0.5f;
    kept.quadric = merged;
    kept.position = target;
    kept.boundary |= gone.boundary;
    ++kept.version;
    ++gone.version;
    mergeFaces(a, b);
    if (face_wedges_.empty()) {
        killWedge(b, a);
        if (alive(a))
            addVersion(a, target);
        else
            killWedge(a, kNone);
        for (const auto& [face, unused] : merged_wedges_) // faces that died: their third corner
            for (const std::uint32_t v : faces_[face])
                if (v != a && v != b && !alive(v) && log_.wedge_death[v] == kNone)
                    killWedge(v, kNone);
    } else {
        mergeWedges(a, b, t);
    }
    return true;
}

void ComponentMesh::dropReference(std::uint32_t v, std::uint32_t face) {
    Ring& ring = rings_[v];
    const auto begin = refs_.begin() + ring.begin;
    const auto at = std::find(begin, begin + ring.count, face);
    assert(at != begin + ring.count);
    std::copy(at + 1, begin + ring.count, at); // order kept: results stay reproducible
    --ring.count;
}

void ComponentMesh::killFace(std::uint32_t face) {
    log_.face_death[face] = step();
    --live_faces_;
}

// Faces on the edge die, b's others become a's. Fills merged_wedges_ with {dead face, 0} when
// wedges are trivial; mergeWedges() fills it anew otherwise.
void ComponentMesh::mergeFaces(std::uint32_t a, std::uint32_t b) {
    merged_wedges_.clear();
    scratch_.clear();
    for (const std::uint32_t f : facesAround(a)) {
        const Corners& face = faces_[f];
        if (face[0] == b || face[1] == b || face[2] == b) {
            killFace(f);
            merged_wedges_.push_back({f, 0});
            for (const std::uint32_t v : face)
                if (v != a && v != b)
                    dropReference(v, f);
        } else {
            scratch_.push_back(f);
        }
    }
    for (const std::uint32_t f : facesAround(b)) {
        if (log_.face_death[f] != kNone)
            continue;
        Corners& face = faces_[f];
        face[face[0] == b ? 0 : face[1] == b ? 1 : 2] = a;
        scratch_.push_back(f);
    }
    const auto count = static_cast<std::uint32_t>(scratch_.size());
    Ring& kept = rings_[a];
    if (count > kept.capacity) {
        kept.begin = static_cast<std::uint32_t>(refs_.size());
        kept.capacity = count;
        refs_.resize(refs_.size() + count);
    }
    std::ranges::copy(scratch_, refs_.begin() + kept.begin);
    kept.count = count;
    rings_[b].count = 0;
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
    float* to = values_.data() + std::size_t{into} * attributes_.size;
    const float* other = values_.data() + std::size_t{from} * attributes_.size;
    for (const WedgeAttributes::Slot& slot : attributes_.slots[wedge_primitive_[into]]) {
        float length2 = 0.0f;
        const std::uint32_t unit_components = slot.tangent ? 3 : slot.components;
        for (std::uint32_t c = 0; c < slot.components; ++c) {
            float& value = to[slot.offset + c];
            const float incoming = other[slot.offset + c];
            if (slot.tangent && c == 3)
                value = t < 0.5f ? value : incoming;
            else
                value += (incoming - value) * t;
            if (c < unit_components)
                length2 += value * value;
        }
        if (slot.unit && length2 > 0.0f)
            for (std::uint32_t c = 0; c < unit_components; ++c)
                to[slot.offset + c] /= std::sqrt(length2);
    }
    if (t > 0.5f)
        wedge_carrier_[into] = wedge_carrier_[from];
}

// Wedges that meet in a face on the edge become one; the others of b move to a as they are, so that
// seams stay seams and no crack opens.
void ComponentMesh::mergeWedges(std::uint32_t a, std::uint32_t b, float t) {
    std::array<std::uint32_t, 3> third{};
    std::vector<std::uint32_t>& touched = scratch_;
    touched.clear();
    const std::size_t dead_faces = merged_wedges_.size();
    for (std::size_t i = 0; i < dead_faces; ++i) {
        const std::uint32_t f = merged_wedges_[i][0];
        std::uint32_t wedge_a = kNone;
        std::uint32_t wedge_b = kNone;
        for (std::size_t k = 0; k < 3; ++k) {
            third[k] = face_wedges_[f][k];
            --wedge_refs_[third[k]];
            touched.push_back(third[k]);
            if (faces_[f][k] == a)
                wedge_a = third[k];
            else if (faces_[f][k] == b)
                wedge_b = third[k];
        }
        merged_wedges_[i] = {wedge_b, wedge_a};
    }
    for (std::size_t i = 0; i < dead_faces; ++i) {
        const auto [from, into] = merged_wedges_[i];
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
    touched.erase(std::ranges::unique(touched).begin(), touched.end());
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
            addVersion(wedge, vertices_[a].position);
    }
}

void ComponentMesh::addVersion(std::uint32_t wedge, Float3 position) {
    const glm::dvec3 p(position.x, position.y, position.z);
    log_.version_wedge.push_back(wedge);
    log_.version_step.push_back(step());
    log_.version_position.emplace_back(origin_ + p * scale_);
    if (face_wedges_.empty())
        return;
    if (attributes_.carries)
        log_.version_carrier.push_back(wedge_carrier_[wedge]);
    const auto from = values_.begin() + static_cast<std::ptrdiff_t>(wedge * attributes_.size);
    log_.version_values.insert(log_.version_values.end(), from, from + attributes_.size);
}

} // namespace lodestone
