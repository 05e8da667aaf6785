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
    dying_.clear();
    if (const std::size_t most = facesAround(a).size() + facesAround(b).size();
        ring_memory_.size() < most)
        ring_memory_.resize(2 * most);
    const auto gather = [&](std::uint32_t v, std::uint32_t other, RingFace* out) {
        for (const std::uint32_t f : facesAround(v)) {
            constexpr std::array<std::uint8_t, 3> kNext{1, 2, 0};
            constexpr std::array<std::uint8_t, 3> kLast{2, 0, 1};
            const Corners& face = faces_[f];
            const std::size_t k = // no branch: which corner it is cannot be foreseen
                static_cast<std::size_t>(face[1] == v) + 2 * static_cast<std::size_t>(face[2] == v);
            const std::uint32_t next = face[kNext[k]];
            const std::uint32_t last = face[kLast[k]];
            *out = {f, next, last};
            if (next != other && last != other)
                ++out;
            else if (v == a)
                dying_.push_back(f);
        }
        return out;
    };
    RingFace* const begin = ring_memory_.data();
    RingFace* const middle = gather(a, b, begin);
    ring_a_ = {begin, middle};
    ring_b_ = {middle, gather(b, a, middle)};
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

// Adds a ring's blocks; the sum of its faces' areas. v: the vertex it is around.
Float3 ComponentMesh::gatherBlocks(std::span<const RingFace> ring, std::uint32_t v) {
    const Vector3<Float4> from = positionsOf({v, v, v, v});
    Vector3<Float4> sum;
    for (std::size_t i = 0; i < ring.size(); i += 4) {
        std::array<std::uint32_t, 4> next;
        std::array<std::uint32_t, 4> last;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const bool there = i + lane < ring.size();
            const RingFace& face = ring[there ? i + lane : i];
            next[lane] = face.next;
            last[lane] = there ? face.last : face.next;
        }
        RingBlock& block = blocks_.emplace_back();
        block.next = positionsOf(next);
        block.side = positionsOf(last) - block.next;
        block.area = cross(block.next - from, block.side);
        sum = sum + block.area;
    }
    const auto across = [](Float4 four) { return (four[0] + four[1]) + (four[2] + four[3]); };
    return {across(sum.x), across(sum.y), across(sum.z)};
}

// Whether no face of the rings turns by more than the flip angle when its vertex moves.
bool ComponentMesh::staysUpright(Float3 to) const {
    const auto all = [](float value) { return Float4{value, value, value, value}; };
    const Vector3<Float4> target{all(to.x), all(to.y), all(to.z)};
    const Float4 zero{};
    for (const RingBlock& block : blocks_) {
        const Vector3<Float4> after = cross(block.next - target, block.side);
        const Float4 before2 = dot(block.area, block.area);
        const Float4 product = dot(block.area, after);
        const Float4 limit = before2 * dot(after, after) * flip_cosine2_;
        // product >= cosine * |before| |after|, without the roots; nothing to turn without an area
        const auto within = flip_sharp_ ? (product > zero) & (product * product >= limit)
                                        : (product >= zero) | (product * product <= limit);
        if (!allOf(within | !(before2 > zero)))
            return false;
    }
    return true;
}

// Moves a place of the merged vertex along the surface's normal towards where the collapse keeps
// the volume (Lindstrom and Turk 1998): planes alone put it outside of what is curved. All the way
// would overdo it next to vertices that still lie outside. at, half: from the edge's middle.
Float3 ComponentMesh::towardsVolume(std::uint32_t a, std::uint32_t b, Float3 at, Float3 half) {
    constexpr float kShare = 0.8f;
    blocks_.clear();
    const Float3 area_a = gatherBlocks(ring_a_, a);
    const Float3 area_b = gatherBlocks(ring_b_, b);
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
    if (strictness != Strictness::Anything && !staysUpright(target))
        return false;
    if (strictness == Strictness::Manifold && !keepsTopology(a, b))
        return false;

    const auto add_up = [&](const Quadric& of_a, const Quadric& of_b) {
        return sum(translated(of_a, target - from_a), translated(of_b, target - from_b));
    };
    Quadric merged = add_up(metrics_[a].quadric, metrics_[b].quadric);
    Quadric shape = merged; // the error as a distance leaves attributes out
    pairWedges(a, b);
    if (wedge_quadrics_.active()) {
        merged = sum(merged, mergeWedgeQuadrics(a, b, target));
        shapes_[a] = shape = add_up(shapes_[a], shapes_[b]);
    }
    log_.cost.push_back(merged.c);
    log_.error2.push_back(shape.weight > 0.0f ? shape.c / shape.weight : 0.0f);
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
        mergeWedges(a, t);
    return true;
}

std::uint32_t ComponentMesh::wedgeAt(std::uint32_t face, std::uint32_t vertex) const {
    if (face_wedges_.empty())
        return vertex_ids_[vertex];
    const Corners& corners = faces_[face];
    return face_wedges_[face][corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2];
}

// Which wedges become one when b goes into a: those that meet in a face on the edge, and with a
// seam that ends at one of both its two sides.
void ComponentMesh::pairWedges(std::uint32_t a, std::uint32_t b) {
    merged_wedges_.clear();
    if (face_wedges_.empty()) {
        merged_wedges_.push_back({vertex_ids_[a], vertex_ids_[b], vertex_ids_[b], vertex_ids_[a]});
        return;
    }
    const auto become = [&](std::uint32_t wedge) {
        for (const MergedWedges& merged : merged_wedges_)
            if (merged.from == wedge)
                wedge = merged.into;
        return wedge;
    };
    for (const std::uint32_t f : facesAround(a)) {
        if (std::ranges::find(faces_[f], b) == faces_[f].end())
            continue;
        const std::uint32_t of_a = wedgeAt(f, a);
        const std::uint32_t of_b = wedgeAt(f, b);
        const std::uint32_t from = become(of_b);
        const std::uint32_t into = become(of_a);
        if (from != into)
            merged_wedges_.push_back({of_a, of_b, from, into});
    }
}

// Moves the predictions of all wedges of both ends to the target and merges those that become one.
// Result: what the vertex's quadric gains, about the target.
Quadric ComponentMesh::mergeWedgeQuadrics(std::uint32_t a, std::uint32_t b, Float3 target) {
    const auto move_all = [&](std::uint32_t v) {
        std::vector<std::uint32_t>& wedges = scratch_;
        wedges.clear();
        for (const std::uint32_t f : facesAround(v))
            wedges.push_back(wedgeAt(f, v));
        std::ranges::sort(wedges);
        wedges.erase(std::unique(wedges.begin(), wedges.end()), wedges.end());
        for (const std::uint32_t wedge : wedges)
            wedge_quadrics_.move(wedge, target - points_[v].position);
    };
    move_all(a);
    move_all(b);
    Quadric gained;
    for (const MergedWedges& merged : merged_wedges_)
        gained = sum(gained, wedge_quadrics_.merge(merged.into, merged.from));
    return gained;
}

// Sets the values that count to the best ones where the wedge lies now.
void ComponentMesh::takeBestValues(std::uint32_t wedge) {
    float* values = values_.data() + std::size_t{wedge} * attributes_.size;
    const std::vector<CountedValue>& counted = counted_[wedge_primitive_[wedge]];
    constexpr float kOpposite2 = 1e-6f; // opposite directions cancel: then the blended one stays
    for (std::size_t i = 0; i < counted.size();) {
        const auto best = [&](std::size_t at) {
            return wedge_quadrics_.value(wedge, at) / counted[at].scale;
        };
        if (!counted[i].unit) {
            values[counted[i].offset] = std::clamp(best(i), counted[i].low, counted[i].high);
            ++i;
            continue;
        }
        const Float3 direction{best(i), best(i + 1), best(i + 2)};
        const float length2 = dot(direction, direction);
        if (length2 > kOpposite2) {
            const Float3 unit = direction * (1.0f / std::sqrt(length2));
            values[counted[i].offset] = unit.x;
            values[counted[i].offset + 1] = unit.y;
            values[counted[i].offset + 2] = unit.z;
        }
        i += 3;
    }
}

// Every vertex is its own wedge.
void ComponentMesh::mergeSingleWedges(std::uint32_t a, std::uint32_t b, float t) {
    const std::uint32_t into = vertex_ids_[a];
    blendValues(into, vertex_ids_[b], t);
    if (wedge_quadrics_.active())
        takeBestValues(into);
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
void ComponentMesh::mergeWedges(std::uint32_t a, float t) {
    std::vector<std::uint32_t>& touched = scratch_;
    touched.clear();
    for (const std::uint32_t f : dying_)
        for (const std::uint32_t wedge : face_wedges_[f]) {
            --wedge_refs_[wedge];
            touched.push_back(wedge);
        }
    for (const auto& [of_a, of_b, from, into] : merged_wedges_) {
        blendValues(into, from, from == of_b ? t : 0.5f);
        wedge_refs_[into] += wedge_refs_[from];
        wedge_refs_[from] = 0;
        killWedge(from, into);
    }
    for (const std::uint32_t f : facesAround(a)) {
        const std::size_t k = faces_[f][0] == a ? 0 : faces_[f][1] == a ? 1 : 2;
        std::uint32_t& wedge = face_wedges_[f][k];
        for (const MergedWedges& merged : merged_wedges_)
            if (wedge == merged.from)
                wedge = merged.into;
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
        if (seen)
            continue;
        if (wedge_quadrics_.active())
            takeBestValues(wedge);
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
