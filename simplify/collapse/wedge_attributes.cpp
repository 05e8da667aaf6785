#include "simplify/collapse/wedge_attributes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace lodestone {

namespace {

using Kind = WedgeAttributes::Kind;
using Slot = WedgeAttributes::Slot;

constexpr std::size_t kInfluences = 4; // of a set
constexpr std::size_t kMostSets = 4;

Kind kindOf(std::string_view semantic) {
    if (semantic == "NORMAL")
        return Kind::Normal;
    if (semantic == "TANGENT")
        return Kind::Tangent;
    if (semantic.starts_with("TEXCOORD_"))
        return Kind::Texcoord;
    if (semantic.starts_with("COLOR_"))
        return Kind::Color;
    return Kind::Carried;
}

// Joints whose weights are there, too, up to kMostSets of them.
void pairSkin(const Geometry& geometry, WedgeAttributes::PrimitiveLayout& layout) {
    for (std::size_t set = 0; set < kMostSets; ++set) {
        const auto find = [&](const std::string& semantic) -> Slot* {
            for (std::size_t a = 0; a < geometry.attributes.size(); ++a)
                if (geometry.attributes[a].semantic == semantic &&
                    geometry.attributes[a].components == kInfluences)
                    return &layout.slots[a];
            return nullptr;
        };
        Slot* joints = find("JOINTS_" + std::to_string(set));
        Slot* weights = find("WEIGHTS_" + std::to_string(set));
        if (joints == nullptr || weights == nullptr)
            return;
        for (Slot* slot : {joints, weights}) {
            slot->kind = Kind::Skin;
            slot->components = kInfluences;
        }
        layout.skin.push_back({}); // offsets follow
    }
}

Slot slotFor(const Attribute& attribute, Kind kind) {
    Slot slot;
    slot.kind = kind;
    slot.components = kind == Kind::Carried || attribute.components > 4 ? 0 : attribute.components;
    if (slot.components == 0)
        slot.kind = Kind::Carried;
    return slot;
}

WedgeAttributes::PrimitiveLayout layoutOf(const Geometry& geometry) {
    WedgeAttributes::PrimitiveLayout layout;
    for (const Attribute& attribute : geometry.attributes)
        layout.slots.push_back(slotFor(attribute, kindOf(attribute.semantic)));
    pairSkin(geometry, layout);
    for (const MorphTarget& target : geometry.morph_targets) {
        std::vector<Slot>& slots = layout.morph_slots.emplace_back();
        for (const Attribute& attribute : target.attributes) {
            slots.push_back(slotFor(attribute, Kind::Plain));
            slots.back().moves = attribute.semantic == "POSITION";
        }
    }
    std::uint32_t offset = 0;
    const auto place = [&](Slot& slot) {
        slot.offset = offset;
        offset += slot.components;
    };
    std::ranges::for_each(layout.slots, place);
    for (std::vector<Slot>& slots : layout.morph_slots)
        std::ranges::for_each(slots, place);
    for (std::size_t set = 0; set < layout.skin.size(); ++set)
        for (std::size_t a = 0; a < geometry.attributes.size(); ++a) {
            const std::string& semantic = geometry.attributes[a].semantic;
            if (semantic == "JOINTS_" + std::to_string(set))
                layout.skin[set].joints = layout.slots[a].offset;
            else if (semantic == "WEIGHTS_" + std::to_string(set))
                layout.skin[set].weights = layout.slots[a].offset;
        }
    return layout;
}

template <class Visit>
void forEverySlot(const Geometry& geometry, WedgeAttributes::PrimitiveLayout& layout, Visit visit) {
    for (std::size_t a = 0; a < layout.slots.size(); ++a)
        visit(geometry.attributes[a], layout.slots[a]);
    for (std::size_t t = 0; t < layout.morph_slots.size(); ++t)
        for (std::size_t a = 0; a < layout.morph_slots[t].size(); ++a)
            visit(geometry.morph_targets[t].attributes[a], layout.morph_slots[t][a]);
}

// out: [components]
void readValues(const Attribute& attribute,
                std::size_t vertex,
                std::size_t components,
                float* out) {
    if (attribute.type == ComponentType::Float32) { // nearly always
        std::memcpy(
            out, attribute.bytes.data() + vertex * attribute.stride(), components * sizeof(float));
        return;
    }
    for (std::size_t c = 0; c < components; ++c)
        out[c] = attributeValue(attribute, vertex, c);
}

void readSlot(const Attribute& attribute,
              Slot& slot,
              const Complex& complex,
              std::size_t primitive,
              WedgeAttributes& all) {
    if (slot.components == 0)
        return;
    slot.low.fill(std::numeric_limits<float>::max());
    slot.high.fill(std::numeric_limits<float>::lowest());
    for (std::size_t w = complex.wedge_begin[primitive]; w < complex.wedge_begin[primitive + 1];
         ++w) {
        float* const values = all.values.data() + w * all.size + slot.offset;
        readValues(attribute, complex.wedge_source[w], slot.components, values);
        for (std::uint32_t c = 0; c < slot.components; ++c) {
            slot.low[c] = std::min(slot.low[c], values[c]);
            slot.high[c] = std::max(slot.high[c], values[c]);
        }
    }
    for (std::size_t c = 0; c < slot.low.size(); ++c)
        if (slot.low[c] > slot.high[c]) // no number among them
            slot.low[c] = slot.high[c] = 0.0f;
}

// Sets area and spacing, without faces that reach absurdly far out.
void measureFaces(const Complex& complex, WedgeAttributes& all) {
    std::size_t faces = 0;
    for (const std::array<std::uint32_t, 3>& face : complex.faces) {
        std::array<glm::dvec3, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            p[k] = glm::dvec3(complex.positions[complex.wedge_vertex[face[k]]]);
        if (!std::ranges::all_of(p, [&](const auto& corner) { return complex.bulk.holds(corner); }))
            continue;
        all.area += 0.5 * glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
        ++faces;
    }
    all.spacing = faces > 0 ? std::sqrt(2.0 * all.area / static_cast<double>(faces)) : 0.0;
}

double extentOf(const Complex& complex) {
    Bounds bounds;
    for (const glm::vec3& position : complex.positions)
        if (complex.bulk.holds(glm::dvec3(position)))
            bounds.add(glm::dvec3(position));
    return bounds.diagonal();
}

// +1 or -1, the same for the same numbers.
float randomSign(std::uint64_t value, std::uint64_t id) {
    std::uint64_t hash = (value + 1) * 0x9E3779B97F4A7C15u + id * 0xBF58476D1CE4E5B9u;
    hash = (hash ^ (hash >> 30)) * 0x94D049BB133111EBu;
    return (hash ^ (hash >> 31)) & 1u ? 1.0f : -1.0f;
}

// One wedge's motion: what its morph targets and its joints (each by `lever`) add up to.
void addMotion(const WedgeAttributes::PrimitiveLayout& layout,
               const Geometry& geometry,
               const float* values,
               float lever,
               float* motion) {
    const float share = 1.0f / std::sqrt(static_cast<float>(WedgeAttributes::kMotionValues));
    for (std::size_t m = 0; m < WedgeAttributes::kMotionValues; ++m) {
        for (std::size_t t = 0; t < layout.morph_slots.size(); ++t)
            for (std::size_t a = 0; a < layout.morph_slots[t].size(); ++a) {
                const Slot& slot = layout.morph_slots[t][a];
                if (geometry.morph_targets[t].attributes[a].semantic != "POSITION")
                    continue;
                for (std::uint32_t c = 0; c < slot.components; ++c)
                    motion[m] += share * randomSign(m, 3 * t + c) * values[slot.offset + c];
            }
        for (const WedgeAttributes::SkinSet& set : layout.skin)
            for (std::size_t i = 0; i < kInfluences; ++i) {
                const auto joint = static_cast<std::uint64_t>(std::abs(values[set.joints + i]));
                motion[m] +=
                    share * lever * randomSign(m, joint + (1u << 20)) * values[set.weights + i];
            }
    }
}

void gatherMotion(const Submesh& submesh, const Complex& complex, WedgeAttributes& all) {
    constexpr double kLever = 0.1; // of the size: how far a vertex lies from its joint
    const auto lever = static_cast<float>(kLever * extentOf(complex));
    all.motion.assign(complex.wedge_source.size() * WedgeAttributes::kMotionValues, 0.0f);
    for (std::size_t p = 0; p < submesh.primitives.size(); ++p)
        for (std::size_t w = complex.wedge_begin[p]; w < complex.wedge_begin[p + 1]; ++w)
            addMotion(all.primitives[p],
                      *submesh.primitives[p].geometry,
                      all.values.data() + w * all.size,
                      lever,
                      all.motion.data() + w * WedgeAttributes::kMotionValues);
}

} // namespace

WedgeAttributes gatherAttributes(const Submesh& submesh, const Complex& complex) {
    WedgeAttributes all;
    bool moves = false;
    for (const Primitive& primitive : submesh.primitives) {
        WedgeAttributes::PrimitiveLayout& layout = all.primitives.emplace_back();
        if (primitive.mode != PrimitiveMode::Triangles)
            continue;
        layout = layoutOf(*primitive.geometry);
        moves |= !layout.skin.empty() || !layout.morph_slots.empty();
        std::uint32_t size = 0;
        forEverySlot(*primitive.geometry, layout, [&](const Attribute&, const Slot& slot) {
            size += slot.components;
            all.carries |= slot.kind == Kind::Carried;
        });
        all.size = std::max(all.size, size);
    }
    all.values.resize(complex.wedge_source.size() * all.size);
    for (std::size_t p = 0; p < submesh.primitives.size(); ++p)
        if (submesh.primitives[p].mode == PrimitiveMode::Triangles)
            forEverySlot(*submesh.primitives[p].geometry,
                         all.primitives[p],
                         [&](const Attribute& attribute, Slot& slot) {
                             readSlot(attribute, slot, complex, p, all);
                         });
    measureFaces(complex, all);
    if (moves)
        gatherMotion(submesh, complex, all);
    return all;
}

std::vector<WedgeAttributes::Charts> gatherCharts(const Complex& complex,
                                                  const WedgeAttributes& attributes) {
    std::vector<WedgeAttributes::Charts> charts(attributes.primitives.size());
    bool any = false;
    for (std::size_t p = 0; p < charts.size(); ++p) {
        const std::vector<Slot>& slots = attributes.primitives[p].slots;
        const auto slot = std::ranges::find_if(slots, [](const Slot& one) {
            return one.kind == Kind::Texcoord && one.components == 2;
        });
        if (slot == slots.end())
            continue;
        any = true;
        charts[p].offset = slot->offset;
        std::vector<ChartMask::Triangle> triangles;
        triangles.reserve(complex.face_begin[p + 1] - complex.face_begin[p]);
        for (std::uint32_t f = complex.face_begin[p]; f < complex.face_begin[p + 1]; ++f) {
            ChartMask::Triangle& triangle = triangles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const float* at = attributes.values.data() +
                                  std::size_t{complex.faces[f][k]} * attributes.size + slot->offset;
                triangle[k] = {at[0], at[1]};
            }
        }
        charts[p].mask = ChartMask(triangles);
    }
    if (!any)
        charts.clear();
    return charts;
}

void blendSkin(float* into,
               const float* from,
               float t,
               std::span<const WedgeAttributes::SkinSet> sets) {
    struct Influence {
        float joint = 0.0f;
        float weight = 0.0f;
    };

    std::array<Influence, 2 * kMostSets * kInfluences> all;
    std::size_t count = 0;
    const auto collect = [&](const float* values, float share) {
        for (const WedgeAttributes::SkinSet& set : sets)
            for (std::size_t i = 0; i < kInfluences; ++i) {
                const float joint = values[set.joints + i];
                const float weight = values[set.weights + i] * share;
                if (!(weight > 0.0f))
                    continue;
                const auto end = all.begin() + static_cast<std::ptrdiff_t>(count);
                const auto known = std::find_if(
                    all.begin(), end, [&](const Influence& one) { return one.joint == joint; });
                if (known != end)
                    known->weight += weight;
                else
                    all[count++] = {joint, weight};
            }
    };
    collect(into, 1.0f - t);
    collect(from, t);
    std::sort(all.begin(),
              all.begin() + static_cast<std::ptrdiff_t>(count),
              [](const Influence& a, const Influence& b) {
                  return a.weight > b.weight || (a.weight == b.weight && a.joint < b.joint);
              });
    count = std::min(count, kInfluences * sets.size());
    float sum = 0.0f;
    for (std::size_t i = 0; i < count; ++i)
        sum += all[i].weight;
    if (!(sum > 0.0f)) // not weighted at all: stays
        return;
    for (std::size_t s = 0; s < sets.size(); ++s)
        for (std::size_t i = 0; i < kInfluences; ++i) {
            const std::size_t at = s * kInfluences + i;
            into[sets[s].joints + i] = at < count ? all[at].joint : 0.0f;
            into[sets[s].weights + i] = at < count ? all[at].weight / sum : 0.0f;
        }
}

} // namespace lodestone
