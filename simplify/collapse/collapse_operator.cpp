// The edge-collapse operator: what may collapse, what dies, what is logged.
#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

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
    const std::size_t most = facesAround(a).size() + facesAround(b).size();
    if (ring_memory_.size() < most)
        ring_memory_.resize(2 * most);
    dying_.resize(most);
    std::uint32_t* dead = dying_.data();
    const auto gather = [&](std::uint32_t v, std::uint32_t other, RingFace* out) {
        for (const std::uint32_t f : facesAround(v)) { // no branch: few die, any of them may
            const Corners& face = faces_[f];
            const std::size_t k = cornerOf(face, v);
            const std::uint32_t next = face[kNext[k]];
            const std::uint32_t last = face[kLast[k]];
            const bool dies = (next == other) | (last == other);
            *out = {f, next, last};
            *dead = f;
            out += static_cast<std::ptrdiff_t>(!dies);
            dead += static_cast<std::ptrdiff_t>(dies);
        }
        return out;
    };
    RingFace* const begin = ring_memory_.data();
    RingFace* const middle = gather(a, b, begin);
    const std::ptrdiff_t dying = dead - dying_.data(); // around b they are found once more
    ring_a_ = {begin, middle};
    ring_b_ = {middle, gather(b, a, middle)};
    dying_.resize(static_cast<std::size_t>(dying));
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
    // Where sheets lie back to back the normal means nothing; extremes stay.
    const bool sound =
        missing * missing < area2 * dot(half, half) && !metrics_[a].extreme && !metrics_[b].extreme;
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
    pairWedges(a, b);
    if (!(options_.seams > 0.0) && releasesSeam(a, b))
        return false;

    const auto add_up = [&](const Quadric& of_a, const Quadric& of_b) {
        return sum(translated(of_a, target - from_a), translated(of_b, target - from_b));
    };
    Quadric merged = add_up(metrics_[a].quadric, metrics_[b].quadric);
    Quadric shape = merged; // the error as a distance leaves attributes out
    if (wedge_quadrics_.active()) {
        merged = sum(merged, mergeWedgeQuadrics(a, b, target));
        shapes_[a] = shape = add_up(shapes_[a], shapes_[b]);
    }
    merge(a, b, target, merged, {merged.c, shape.weight > 0.0f ? shape.c / shape.weight : 0.0f});
    return true;
}

void ComponentMesh::merge(std::uint32_t a,
                          std::uint32_t b,
                          Float3 target,
                          const Quadric& merged,
                          const StepError& error) {
    const Float3 half = (points_[b].position - points_[a].position) * 0.5f;
    const Float3 at = target - (points_[a].position + half);
    log_.cost.push_back(error.cost);
    log_.error2.push_back(error.error2);
    metrics_[a].quadric = merged;
    metrics_[a].boundary |= metrics_[b].boundary;
    metrics_[a].extreme |= metrics_[b].extreme;
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
            if ((v != a) & (v != b))
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
        corners[cornerOf(corners, b)] = a;
        *to++ = face.face;
    }
}

void ComponentMesh::reorderSteps(std::uint32_t first_step, std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> place(order.size()); // of each step, from first_step on
    std::vector<float> costs(order.size());
    std::vector<float> errors(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        place[order[i]] = i;
        costs[i] = log_.cost[first_step + order[i]];
        errors[i] = log_.error2[first_step + order[i]];
    }
    std::ranges::copy(costs, log_.cost.begin() + first_step);
    std::ranges::copy(errors, log_.error2.begin() + first_step);
    const auto moved = [&](std::uint32_t step) {
        return first_step + 1 + place[step - first_step - 1];
    };
    for (const std::uint32_t face : face_ids_) {
        std::uint32_t& death = log_.face_death[face];
        if (death != kNone && death > first_step)
            death = moved(death);
    }
    for (std::size_t v = log_.version_step.size(); v-- > 0 && log_.version_step[v] > first_step;)
        log_.version_step[v] = moved(log_.version_step[v]);
    // The wedges that each step has killed lie together.
    std::size_t kill_begin = log_.kill_order.size();
    std::vector<std::uint32_t> begin(order.size() + 1, 0);
    while (kill_begin > 0 && log_.wedge_death[log_.kill_order[kill_begin - 1]] > first_step)
        ++begin[log_.wedge_death[log_.kill_order[--kill_begin]] - first_step];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    const std::vector<std::uint32_t> kills(
        log_.kill_order.begin() + static_cast<std::ptrdiff_t>(kill_begin), log_.kill_order.end());
    std::size_t at = kill_begin;
    for (std::uint32_t i = 0; i < order.size(); ++i)
        for (std::uint32_t k = begin[order[i]]; k < begin[order[i] + 1]; ++k) {
            log_.kill_order[at++] = kills[k];
            log_.wedge_death[kills[k]] = first_step + 1 + i;
        }
}

} // namespace lodestone
