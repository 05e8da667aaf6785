// What collapses would cost: the shape's quadrics and, where attributes count, those of wedges.
#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lodestone {

// --- attributes

// How much longer a way is on the surface than in a texture's coordinates: the root of the ratio
// of the areas. 0 where all of the component has one coordinate.
float ComponentMesh::texcoordScale(std::uint32_t primitive,
                                   const WedgeAttributes::Slot& slot) const {
    double area = 0.0;
    double texture_area = 0.0;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        std::array<std::uint32_t, 3> wedges;
        for (std::size_t k = 0; k < 3; ++k)
            wedges[k] = wedgeAt(f, faces_[f][k]);
        if (wedge_primitive_[wedges[0]] != primitive)
            continue;
        const auto at = [&](std::size_t corner) {
            return values_.data() + std::size_t{wedges[corner]} * attributes_.size + slot.offset;
        };
        const float ux = at(1)[0] - at(0)[0];
        const float uy = at(1)[1] - at(0)[1];
        const float vx = at(2)[0] - at(0)[0];
        const float vy = at(2)[1] - at(0)[1];
        const Float3 normal = faceNormal(faces_[f]);
        area += std::sqrt(static_cast<double>(dot(normal, normal)));
        texture_area += std::abs(static_cast<double>(ux) * vy - static_cast<double>(uy) * vx);
    }
    const double scale = texture_area > 0.0 ? std::sqrt(area / texture_area) : 0.0;
    return std::isfinite(scale) ? static_cast<float>(scale) : 0.0f;
}

// What makes an attribute's values lengths; 0: they do not count.
float ComponentMesh::valueScale(std::uint32_t primitive, const WedgeAttributes::Slot& slot) const {
    const AttributeWeights& weights = options_.attributes;
    const double spacing = attributes_.spacing / scale_;
    switch (slot.kind) {
    case WedgeAttributes::Kind::Normal:
        return static_cast<float>(spacing * weights.normal);
    case WedgeAttributes::Kind::Color:
        return static_cast<float>(spacing * weights.color);
    case WedgeAttributes::Kind::Texcoord:
        return weights.texcoord > 0.0
                   ? static_cast<float>(weights.texcoord) * texcoordScale(primitive, slot)
                   : 0.0f;
    default:
        return 0.0f;
    }
}

// Sets which values count and resets the wedges' quadrics.
void ComponentMesh::chooseValues() {
    counted_.assign(attributes_.primitives.size(), {});
    std::vector<bool> present(counted_.size(), false);
    for (const std::uint32_t primitive : wedge_primitive_)
        present[primitive] = true;
    std::size_t count = 0;
    for (std::uint32_t p = 0; p < counted_.size(); ++p) {
        if (!present[p])
            continue;
        for (const WedgeAttributes::Slot& slot : attributes_.primitives[p].slots) {
            const float scale = valueScale(p, slot);
            const bool unit = slot.kind == WedgeAttributes::Kind::Normal;
            for (std::uint32_t c = 0; scale > 0.0f && c < slot.components; ++c)
                counted_[p].push_back(
                    {slot.offset + c, scale, slot.low[c], slot.high[c], unit && c == 0});
        }
        count = std::max(count, counted_[p].size());
    }
    motion_scale_ =
        attributes_.motion.empty() ? 0.0f : static_cast<float>(options_.attributes.motion / scale_);
    if (motion_scale_ > 0.0f)
        count += WedgeAttributes::kMotionValues;
    wedge_quadrics_.reset(log_.wedges.size(), count);
    shapes_.clear();
}

// [WedgeQuadrics::valueCount()]; what a primitive has fewer of is 0. Nonsense of the file stays in
// bounds.
void ComponentMesh::scaledValues(std::uint32_t wedge, std::span<float> out) const {
    std::ranges::fill(out, 0.0f);
    const float* values = values_.data() + std::size_t{wedge} * attributes_.size;
    const std::vector<CountedValue>& counted = counted_[wedge_primitive_[wedge]];
    constexpr float kMost = 1e6f; // mesh sizes
    for (std::size_t i = 0; i < counted.size(); ++i) {
        const float value = values[counted[i].offset] * counted[i].scale;
        out[i] = std::isfinite(value) ? std::clamp(value, -kMost, kMost) : 0.0f;
    }
    if (!(motion_scale_ > 0.0f))
        return;
    const float* motion = attributes_.motion.data() +
                          std::size_t{log_.wedges[wedge]} * WedgeAttributes::kMotionValues;
    for (std::size_t m = 0; m < WedgeAttributes::kMotionValues; ++m) {
        const float value = motion[m] * motion_scale_;
        out[out.size() - WedgeAttributes::kMotionValues + m] =
            std::isfinite(value) ? std::clamp(value, -kMost, kMost) : 0.0f;
    }
}

void ComponentMesh::buildWedgeQuadrics() {
    shapes_.reserve(metrics_.size());
    for (const Metric& metric : metrics_)
        shapes_.push_back(metric.quadric);
    std::vector<float> values(wedge_quadrics_.valueCount());
    for (std::uint32_t wedge = 0; wedge < log_.wedges.size(); ++wedge) {
        scaledValues(wedge, values);
        wedge_quadrics_.setValues(wedge, values);
    }
    WedgeQuadrics::Face face;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
        face.weight = face_weights_[f];
        if (!(face.weight > 0.0f))
            continue;
        for (std::size_t k = 0; k < 3; ++k) {
            face.positions[k] = points_[faces_[f][k]].position;
            face.wedges[k] = wedgeAt(f, faces_[f][k]);
        }
        const Quadric gained = wedge_quadrics_.addFace(face);
        for (const std::uint32_t v : faces_[f])
            metrics_[v].quadric = sum(metrics_[v].quadric, gained);
    }
    std::uint32_t next = 0; // wedges are numbered by first use
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
        for (const std::uint32_t v : faces_[f])
            if (wedgeAt(f, v) == next)
                metrics_[v].quadric =
                    difference(metrics_[v].quadric, wedge_quadrics_.finish(next++));
}

// --- edges

Placement ComponentMesh::place(std::uint32_t a, std::uint32_t b) {
    const Quadric& p = metrics_[a].quadric;
    const Quadric& q = metrics_[b].quadric;
    const Float3 half = (points_[b].position - points_[a].position) * 0.5f;
    if (!wedge_quadrics_.active())
        return placeEdge(p, q, half);
    Quadric sum = sumAtMiddle(p, q, half);
    pairWedges(a, b);
    for (const MergedWedges& merged : merged_wedges_)
        wedge_quadrics_.addMerge(sum, merged.of_a, merged.of_b, half);
    return placeMerged(sum, p.c + q.c, half);
}

// The wedges that meet along each spoke from v.
void ComponentMesh::gatherSpokePairs(std::uint32_t v) {
    constexpr std::array<std::uint32_t, 2> kNoPair{kNone, kNone};
    spoke_pairs_.assign(spokes_.size(), {kNoPair, kNoPair});
    for (std::uint32_t i = 0; i < spokes_.size(); ++i)
        mark_face_[spokes_[i]] = i;
    const auto accepted = [&](std::uint32_t other) {
        return other != v && mark_face_[other] < spokes_.size() &&
               spokes_[mark_face_[other]] == other;
    };
    for (const std::uint32_t face : facesAround(v)) {
        const std::uint32_t own = wedgeAt(face, v);
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t other = faces_[face][k];
            if (!accepted(other))
                continue;
            SpokePairs& pairs = spoke_pairs_[mark_face_[other]];
            const std::array pair{own, face_wedges_[face][k]};
            if (pairs[0] == kNoPair)
                pairs[0] = pair;
            else if (pairs[0] != pair && pairs[1] == kNoPair)
                pairs[1] = pair;
        }
    }
}

// Whether a seam ends or two seams merge when an edge collapses: every wedge of one end must find
// one of its own at the other.
bool ComponentMesh::releasesSeam(std::uint32_t v,
                                 std::uint32_t other,
                                 const SpokePairs& pairs) const {
    const std::uint32_t least = std::min(wedge_counts_[v], wedge_counts_[other]);
    if (pairs[1][0] == kNone)
        return least > 1;
    return least != 2 || pairs[0][0] == pairs[1][0] || pairs[0][1] == pairs[1][1];
}

// What merging the wedges along four spokes costs.
void ComponentMesh::addMerges(const std::array<std::size_t, 4>& spokes,
                              const Vector3<Float4>& half,
                              QuadricOf<Float4>& sum) const {
    for (std::size_t side = 0; wedge_quadrics_.active() && side < 2; ++side) {
        std::array<std::uint32_t, 4> own{};
        std::array<std::uint32_t, 4> other{};
        Float4 share{};
        bool any = false;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            const auto& [v_wedge, other_wedge] = spoke_pairs_[spokes[lane]][side];
            if (v_wedge == kNone)
                continue;
            own[lane] = v_wedge;
            other[lane] = other_wedge;
            share[lane] = 1.0f;
            any = true;
        }
        if (any)
            wedge_quadrics_.addMerges(sum, own, other, half, share);
    }
}

namespace {

QuadricOf<Float4> inAllLanes(const Quadric& q) {
    const auto all = [](float value) { return Float4{value, value, value, value}; };
    return {all(q.xx),
            all(q.yy),
            all(q.zz),
            all(q.xy),
            all(q.xz),
            all(q.yz),
            all(q.bx),
            all(q.by),
            all(q.bz),
            all(q.c),
            Float4{}};
}

// Four quadrics side by side, without their weights.
QuadricOf<Float4> lanes(const std::array<const Quadric*, 4>& q) {
    static_assert(offsetof(Quadric, xy) == 3 * sizeof(float) &&
                  offsetof(Quadric, xz) == 4 * sizeof(float) &&
                  offsetof(Quadric, by) == 7 * sizeof(float) &&
                  offsetof(Quadric, weight) == 10 * sizeof(float));
    const auto columns = [&](float Quadric::*first) {
        return transposed({loadFour(&(q[0]->*first)),
                           loadFour(&(q[1]->*first)),
                           loadFour(&(q[2]->*first)),
                           loadFour(&(q[3]->*first))});
    };
    const auto [xx, yy, zz, xy] = columns(&Quadric::xx);
    const auto [xz, yz, bx, skipped] = columns(&Quadric::xz);
    const auto [by, bz, c, weight] = columns(&Quadric::by);
    return {xx, yy, zz, xy, xz, yz, bx, by, bz, c, Float4{}};
}

} // namespace

template <ComponentMesh::SpokeWedges wedges>
void ComponentMesh::costSpokeEdges(std::uint32_t v) {
    const QuadricOf<Float4> first = inAllLanes(metrics_[v].quadric);
    const Vector3<Float4> from = positionsOf({v, v, v, v});
    for (std::size_t i = 0; i < spokes_.size(); i += 4) {
        std::array<std::size_t, 4> spoke; // the last ones repeat where fewer than four are left
        std::array<std::uint32_t, 4> id;
        for (std::size_t lane = 0; lane < 4; ++lane) {
            spoke[lane] = std::min(i + lane, spokes_.size() - 1);
            id[lane] = spokes_[spoke[lane]];
        }
        const Vector3<Float4> half = (positionsOf(id) - from) * 0.5f;
        const QuadricOf<Float4> second = lanes({&metrics_[id[0]].quadric,
                                                &metrics_[id[1]].quadric,
                                                &metrics_[id[2]].quadric,
                                                &metrics_[id[3]].quadric});
        QuadricOf<Float4> sum = sumAtMiddle(first, second, half);
        if constexpr (wedges == SpokeWedges::OneEach) {
            const std::uint32_t own = vertex_ids_[v];
            wedge_quadrics_.addMerges(
                sum,
                {own, own, own, own},
                {vertex_ids_[id[0]], vertex_ids_[id[1]], vertex_ids_[id[2]], vertex_ids_[id[3]]},
                half,
                Float4{1.0f, 1.0f, 1.0f, 1.0f});
        }
        if constexpr (wedges == SpokeWedges::Several)
            addMerges(spoke, half, sum);
        const PlacementOf<Float4> placed = placeMerged(sum, first.c + second.c, half);
        for (std::size_t lane = 0; lane < std::min<std::size_t>(4, spokes_.size() - i); ++lane)
            spoke_keys_[i + lane] = placed.key[lane];
    }
    if constexpr (wedges == SpokeWedges::Several)
        for (std::size_t i = 0; options_.seams > 0.0 && i < spokes_.size(); ++i)
            if (!wedge_counts_.empty() && releasesSeam(v, spokes_[i], spoke_pairs_[i]))
                spoke_keys_[i] /= static_cast<float>(options_.seams);
}

template void ComponentMesh::costSpokeEdges<ComponentMesh::SpokeWedges::None>(std::uint32_t v);
template void ComponentMesh::costSpokeEdges<ComponentMesh::SpokeWedges::OneEach>(std::uint32_t v);
template void ComponentMesh::costSpokeEdges<ComponentMesh::SpokeWedges::Several>(std::uint32_t v);

} // namespace lodestone
