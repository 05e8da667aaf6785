// What a collapse does to the wedges of its two ends.
#include "simplify/collapse/component_mesh.h"

#include <algorithm>
#include <cmath>

namespace lodestone {

std::uint32_t ComponentMesh::wedgeAt(std::uint32_t face, std::uint32_t vertex) const {
    if (face_wedges_.empty())
        return vertex_ids_[vertex];
    return face_wedges_[face][cornerOf(faces_[face], vertex)];
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

// Whether a seam ends or two seams merge when b goes into a. After pairWedges().
bool ComponentMesh::releasesSeam(std::uint32_t a, std::uint32_t b) const {
    if (wedge_counts_.empty())
        return false;
    std::size_t pairs = 0; // of wedges that no other pair has
    for (const MergedWedges& merged : merged_wedges_) {
        if (merged.from != merged.of_b) // of_b went elsewhere already
            return true;
        for (const MergedWedges& other : merged_wedges_)
            if (&other != &merged && other.into == merged.into)
                return true;
        ++pairs;
    }
    return pairs < std::min(wedge_counts_[a], wedge_counts_[b]);
}

// Moves the predictions of all wedges of both ends to the target and merges those that become one.
// Result: what the vertex's quadric gains, about the target.
Quadric ComponentMesh::mergeWedgeQuadrics(std::uint32_t a, std::uint32_t b, Float3 target) {
    if (face_wedges_.empty()) { // one each
        wedge_quadrics_.move(vertex_ids_[a], target - points_[a].position);
        wedge_quadrics_.move(vertex_ids_[b], target - points_[b].position);
        return wedge_quadrics_.merge(vertex_ids_[a], vertex_ids_[b]);
    }
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

// Sets the values that count to the best ones where the wedge lies now. Texture coordinates that
// would lie outside of all charts stay as blended: out there the texture shows anything.
void ComponentMesh::takeBestValues(std::uint32_t wedge) {
    float* values = values_.data() + std::size_t{wedge} * attributes_.size;
    const std::uint32_t primitive = wedge_primitive_[wedge];
    const std::vector<CountedValue>& counted = counted_[primitive];
    const WedgeAttributes::Charts* charts =
        attributes_.charts.empty() || !attributes_.charts[primitive].mask.covers()
            ? nullptr
            : &attributes_.charts[primitive];
    constexpr float kOpposite2 = 1e-6f; // opposite directions cancel: then the blended one stays
    for (std::size_t i = 0; i < counted.size();) {
        const auto best = [&](std::size_t at) {
            return wedge_quadrics_.value(wedge, at) / counted[at].scale;
        };
        const auto best_within = [&](std::size_t at) {
            return std::clamp(best(at), counted[at].low, counted[at].high);
        };
        if (charts && counted[i].offset == charts->offset) {
            const glm::vec2 coordinates(best_within(i), best_within(i + 1));
            if (charts->mask.holds(coordinates)) {
                values[counted[i].offset] = coordinates.x;
                values[counted[i].offset + 1] = coordinates.y;
            }
            i += 2;
            continue;
        }
        if (!counted[i].unit) {
            values[counted[i].offset] = best_within(i);
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

void ComponentMesh::killWedge(std::uint32_t wedge, std::uint32_t parent) {
    log_.wedge_death[wedge] = step();
    log_.wedge_parent[wedge] = parent;
    log_.kill_order.push_back(wedge);
}

void ComponentMesh::releaseWedge(std::uint32_t wedge) {
    if (wedge_refs_[wedge] == 0 && log_.wedge_death[wedge] == kNone)
        killWedge(wedge, kNone);
}

namespace {

// Moves a slot's values by t towards the other wedge's.
void blendSlot(const WedgeAttributes::Slot& slot, float* to, const float* other, float t) {
    using Kind = WedgeAttributes::Kind;
    if (slot.kind == Kind::Skin || slot.kind == Kind::Carried)
        return;
    constexpr float kOpposite2 = 1e-6f; // opposite directions cancel: then the first one stays
    const bool tangent = slot.kind == Kind::Tangent;
    const bool unit = tangent || slot.kind == Kind::Normal;
    const std::uint32_t blended = tangent ? std::min(3u, slot.components) : slot.components;
    float length2 = 0.0f;
    for (std::uint32_t c = slot.offset; c < slot.offset + blended; ++c) {
        const float value = to[c] + (other[c] - to[c]) * t;
        length2 += value * value;
    }
    if (unit && !(length2 > kOpposite2))
        return;
    const float scale = unit ? 1.0f / std::sqrt(length2) : 1.0f;
    for (std::uint32_t c = slot.offset; c < slot.offset + blended; ++c)
        to[c] = (to[c] + (other[c] - to[c]) * t) * scale;
    if (tangent && slot.components == 4 && t > 0.5f)
        to[slot.offset + 3] = other[slot.offset + 3];
}

} // namespace

void ComponentMesh::blendValues(std::uint32_t into, std::uint32_t from, float t) {
    if (attributes_.carries && t > 0.5f)
        wedge_carrier_[into] = wedge_carrier_[from];
    if (attributes_.size == 0)
        return;
    float* to = values_.data() + std::size_t{into} * attributes_.size;
    const float* other = values_.data() + std::size_t{from} * attributes_.size;
    const WedgeAttributes::PrimitiveLayout& layout = attributes_.primitives[wedge_primitive_[into]];
    for (const WedgeAttributes::Slot& slot : layout.slots)
        blendSlot(slot, to, other, t);
    for (const std::vector<WedgeAttributes::Slot>& target : layout.morph_slots)
        for (const WedgeAttributes::Slot& slot : target)
            blendSlot(slot, to, other, t);
    if (!layout.skin.empty())
        blendSkin(to, other, t, layout.skin);
}

// Joints and morph targets move a wedge as they move another one that lies at the same place: else
// seams would open as soon as the mesh moves.
void ComponentMesh::moveAlike(std::uint32_t wedge, std::uint32_t like) {
    const auto& to_layout = attributes_.primitives[wedge_primitive_[wedge]];
    const auto& from_layout = attributes_.primitives[wedge_primitive_[like]];
    float* to = values_.data() + std::size_t{wedge} * attributes_.size;
    const float* from = values_.data() + std::size_t{like} * attributes_.size;
    if (to_layout.skin.size() == from_layout.skin.size())
        for (std::size_t set = 0; set < to_layout.skin.size(); ++set) {
            constexpr std::size_t kInfluences = 4;
            std::copy_n(
                from + from_layout.skin[set].joints, kInfluences, to + to_layout.skin[set].joints);
            std::copy_n(from + from_layout.skin[set].weights,
                        kInfluences,
                        to + to_layout.skin[set].weights);
        }
    const auto moving = [](const WedgeAttributes::Slot& slot) { return slot.moves; };
    const std::size_t targets =
        std::min(to_layout.morph_slots.size(), from_layout.morph_slots.size());
    for (std::size_t t = 0; t < targets; ++t) {
        const auto into = std::ranges::find_if(to_layout.morph_slots[t], moving);
        const auto source = std::ranges::find_if(from_layout.morph_slots[t], moving);
        if (into != to_layout.morph_slots[t].end() && source != from_layout.morph_slots[t].end() &&
            into->components == source->components)
            std::copy_n(from + source->offset, source->components, to + into->offset);
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
        std::uint32_t& wedge = face_wedges_[f][cornerOf(faces_[f], a)];
        for (const MergedWedges& merged : merged_wedges_)
            if (wedge == merged.from)
                wedge = merged.into;
        touched.push_back(wedge);
    }
    std::ranges::sort(touched);
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const std::uint32_t wedge : touched)
        releaseWedge(wedge);
    std::uint32_t like = merged_wedges_.empty() ? kNone : merged_wedges_.front().into;
    for (const MergedWedges& merged : merged_wedges_)
        if (merged.from == like)
            like = merged.into;
    for (const std::uint32_t f : facesAround(a)) {
        const std::uint32_t wedge = wedgeAt(f, a);
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
        if (!attributes_.motion.empty() && like != kNone && wedge != like)
            moveAlike(wedge, like);
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
