// From a sequence and a step to meshes.
#include "simplify/collapse/read_ends.h"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr std::size_t kGrain = 16'384; // elements a task

template <class Body>
void forBlocks(std::size_t count, Body body) {
    if (count <= kGrain) {
        body(std::size_t{0}, count);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kGrain),
                      [&](const auto& range) { body(range.begin(), range.end()); });
}

// Stable compaction in parallel: keep(i) decides, emit(i, at) writes. Returns how many were kept.
template <class Keep, class Emit>
std::size_t compact(std::size_t begin, std::size_t end, Keep keep, Emit emit) {
    const std::size_t blocks = (end - begin + kGrain - 1) / kGrain;
    std::vector<std::size_t> at(blocks + 1, 0);
    const auto block_end = [&](std::size_t b) { return std::min(end, begin + (b + 1) * kGrain); };
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        std::size_t count = 0;
        for (std::size_t i = begin + b * kGrain; i < block_end(b); ++i)
            count += keep(i);
        at[b + 1] = count;
    });
    std::partial_sum(at.begin(), at.end(), at.begin());
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t b) {
        std::size_t to = at[b];
        for (std::size_t i = begin + b * kGrain; i < block_end(b); ++i)
            if (keep(i))
                emit(i, to++);
    });
    return at.back();
}

// The last version of a wedge that holds at a step; kNone: still as in the file.
std::uint32_t versionAt(const CollapseSequence& sequence, std::uint32_t wedge, std::uint32_t step) {
    const auto begin = sequence.version_step.begin() + sequence.version_begin[wedge];
    const auto end = sequence.version_step.begin() + sequence.version_begin[wedge + 1];
    const auto after = std::upper_bound(begin, end, step);
    return after == begin ? kNone
                          : static_cast<std::uint32_t>(after - sequence.version_step.begin() - 1);
}

// The alive wedges of a primitive and where they stand at a step.
struct AliveWedges {
    std::vector<std::uint32_t> wedges;
    std::vector<std::uint32_t> versions; // kNone: as in the file
};

struct ReadOut {
    const CollapseSequence& sequence;
    const Submesh& submesh;
    std::uint32_t step;
    double scale;
    glm::dvec3 pivot;
    std::vector<std::uint32_t> stands_for; // [wedges]
    std::vector<std::uint32_t> vertex_of;  // [wedges] in its primitive's new geometry

    glm::vec3 scaled(const glm::vec3& p) const {
        return scale == 1.0 ? p : glm::vec3(pivot + (glm::dvec3(p) - pivot) * scale);
    }

    std::uint32_t carrier(std::uint32_t wedge, std::uint32_t version) const {
        return version == kNone || sequence.version_carrier.empty()
                   ? wedge
                   : sequence.version_carrier[version];
    }

    AliveWedges findAlive(std::size_t primitive);
    void fillPositions(std::size_t primitive, const AliveWedges& alive, Geometry& to) const;
    void fillCarried(const AliveWedges& alive, const Attribute& from, Attribute& to) const;
    void fillBlended(const AliveWedges& alive,
                     const WedgeAttributes::Slot& slot,
                     const Attribute& from,
                     Attribute& to) const;
    void fillAttribute(const AliveWedges& alive,
                       const WedgeAttributes::Slot& slot,
                       const Attribute& from,
                       Attribute& to) const;
    void settleWeights(const AliveWedges& alive, std::vector<Attribute>& attributes) const;
    void fillVertices(std::size_t primitive, const AliveWedges& alive, Geometry& to) const;
    void fillMorphTargets(std::size_t primitive, const AliveWedges& alive, Geometry& to) const;
    void fillIndices(std::size_t primitive, Geometry& to) const;
    GeometryPtr readPrimitive(std::size_t primitive);
};

AliveWedges ReadOut::findAlive(std::size_t primitive) {
    AliveWedges alive;
    const std::size_t count = sequence.counts[primitive].wedges[step];
    alive.wedges.resize(count);
    alive.versions.resize(count);
    compact(
        sequence.complex.wedge_begin[primitive],
        sequence.complex.wedge_begin[primitive + 1],
        [&](std::size_t w) { return sequence.wedge_death[w] > step; },
        [&](std::size_t w, std::size_t at) {
            const auto wedge = static_cast<std::uint32_t>(w);
            alive.wedges[at] = wedge;
            alive.versions[at] = versionAt(sequence, wedge, step);
            vertex_of[w] = static_cast<std::uint32_t>(at);
        });
    return alive;
}

void ReadOut::fillPositions(std::size_t primitive, const AliveWedges& alive, Geometry& to) const {
    const Geometry& from = *submesh.primitives[primitive].geometry;
    to.positions.resize(alive.wedges.size());
    forBlocks(alive.wedges.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t version = alive.versions[i];
            const std::uint32_t wedge = alive.wedges[i];
            const glm::vec3& at = version == kNone
                                      ? from.positions[sequence.complex.wedge_source[wedge]]
                                      : sequence.version_position[version];
            to.positions[i] = scaled(sequence.crowds.grown(primitive, wedge, step, at));
        }
    });
}

Attribute emptyLike(const Attribute& from, std::size_t vertices) {
    Attribute to{from.semantic, from.type, from.components, from.normalized, {}};
    to.bytes.resize(vertices * from.stride());
    return to;
}

void scaleValues(Attribute& attribute, float scale) {
    const std::size_t vertices = attribute.bytes.size() / attribute.stride();
    for (std::size_t v = 0; v < vertices; ++v)
        for (std::size_t c = 0; c < attribute.components; ++c)
            setAttributeValue(attribute, v, c, attributeValue(attribute, v, c) * scale);
}

void ReadOut::fillCarried(const AliveWedges& alive, const Attribute& from, Attribute& to) const {
    const std::size_t stride = from.stride();
    for (std::size_t i = 0; i < alive.wedges.size(); ++i) {
        const std::uint32_t wedge = carrier(alive.wedges[i], alive.versions[i]);
        std::memcpy(to.bytes.data() + i * stride,
                    from.bytes.data() + sequence.complex.wedge_source[wedge] * stride,
                    stride);
    }
}

void ReadOut::fillBlended(const AliveWedges& alive,
                          const WedgeAttributes::Slot& slot,
                          const Attribute& from,
                          Attribute& to) const {
    const std::size_t stride = from.stride();
    forBlocks(alive.wedges.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t version = alive.versions[i];
            std::byte* out = to.bytes.data() + i * stride;
            if (version == kNone) {
                const std::size_t source = sequence.complex.wedge_source[alive.wedges[i]];
                std::memcpy(out, from.bytes.data() + source * stride, stride);
                continue;
            }
            const float* values = sequence.version_values.data() +
                                  std::size_t{version} * sequence.attributes.size + slot.offset;
            if (from.type == ComponentType::Float32)
                std::memcpy(out, values, stride);
            else
                for (std::uint32_t c = 0; c < slot.components; ++c)
                    setAttributeValue(to, i, c, values[c]);
        }
    });
}

void ReadOut::fillAttribute(const AliveWedges& alive,
                            const WedgeAttributes::Slot& slot,
                            const Attribute& from,
                            Attribute& to) const {
    if (slot.kind == WedgeAttributes::Kind::Carried)
        fillCarried(alive, from, to);
    else
        fillBlended(alive, slot, from, to);
}

// Weights stored as integers must sum to 1 to the last bit: the first, strongest one takes what
// rounding left over.
void ReadOut::settleWeights(const AliveWedges& alive, std::vector<Attribute>& attributes) const {
    std::vector<Attribute*> sets;
    for (Attribute& attribute : attributes)
        if (attribute.semantic.starts_with("WEIGHTS_") && attribute.normalized)
            sets.push_back(&attribute);
    for (std::size_t i = 0; !sets.empty() && i < alive.wedges.size(); ++i) {
        if (alive.versions[i] == kNone)
            continue;
        float sum = 0.0f;
        for (const Attribute* set : sets)
            for (std::size_t c = 0; c < set->components; ++c)
                sum += attributeValue(*set, i, c);
        if (sum > 0.0f)
            setAttributeValue(*sets[0], i, 0, attributeValue(*sets[0], i, 0) + 1.0f - sum);
    }
}

void ReadOut::fillIndices(std::size_t primitive, Geometry& to) const {
    const Complex& complex = sequence.complex;
    to.indices.resize(std::size_t{3} * sequence.counts[primitive].faces[step]);
    compact(
        complex.face_begin[primitive],
        complex.face_begin[primitive + 1],
        [&](std::size_t f) { return sequence.face_death[f] > step; },
        [&](std::size_t f, std::size_t at) {
            for (std::size_t k = 0; k < 3; ++k)
                to.indices[3 * at + k] = vertex_of[stands_for[complex.faces[f][k]]];
        });
}

// Positions and attributes.
void ReadOut::fillVertices(std::size_t primitive, const AliveWedges& alive, Geometry& to) const {
    const Geometry& from = *submesh.primitives[primitive].geometry;
    const WedgeAttributes::PrimitiveLayout& layout = sequence.attributes.primitives[primitive];
    fillPositions(primitive, alive, to);
    for (std::size_t a = 0; a < from.attributes.size(); ++a) {
        to.attributes.push_back(emptyLike(from.attributes[a], alive.wedges.size()));
        fillAttribute(alive, layout.slots[a], from.attributes[a], to.attributes.back());
    }
    if (!layout.skin.empty())
        settleWeights(alive, to.attributes);
}

void ReadOut::fillMorphTargets(std::size_t primitive,
                               const AliveWedges& alive,
                               Geometry& to) const {
    const Geometry& from = *submesh.primitives[primitive].geometry;
    const WedgeAttributes::PrimitiveLayout& layout = sequence.attributes.primitives[primitive];
    for (std::size_t t = 0; t < from.morph_targets.size(); ++t) {
        std::vector<Attribute>& out = to.morph_targets.emplace_back().attributes;
        for (std::size_t a = 0; a < from.morph_targets[t].attributes.size(); ++a) {
            const Attribute& attribute = from.morph_targets[t].attributes[a];
            out.push_back(emptyLike(attribute, alive.wedges.size()));
            fillAttribute(alive, layout.morph_slots[t][a], attribute, out.back());
            if (attribute.semantic == "POSITION" && scale != 1.0)
                scaleValues(out.back(), static_cast<float>(scale));
        }
    }
}

GeometryPtr ReadOut::readPrimitive(std::size_t primitive) {
    const Primitive& source = submesh.primitives[primitive];
    if (source.mode != PrimitiveMode::Triangles)
        return source.geometry;
    auto to = std::make_shared<Geometry>();
    const AliveWedges alive = findAlive(primitive);
    fillVertices(primitive, alive, *to);
    fillMorphTargets(primitive, alive, *to);
    fillIndices(primitive, *to);
    return to;
}

// Ready to read: wedges are resolved.
ReadOut readingAt(const CollapseSequence& sequence,
                  const Submesh& submesh,
                  std::uint32_t step,
                  double scale,
                  const glm::dvec3& pivot) {
    ReadOut read{sequence, submesh, step, scale, pivot, {}, {}};
    read.stands_for.resize(sequence.complex.wedge_source.size());
    read.vertex_of.resize(read.stands_for.size());
    resolveWedges(sequence, step, read.stands_for);
    return read;
}

} // namespace

void resolveWedges(const CollapseSequence& sequence,
                   std::uint32_t step,
                   std::span<std::uint32_t> out) {
    forBlocks(out.size(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t w = begin; w < end; ++w)
            out[w] = static_cast<std::uint32_t>(w);
    });
    const std::size_t components = sequence.kill_begin.size() - 1;
    const auto resolve = [&](std::size_t component) {
        const auto begin = sequence.kill_order.begin() + sequence.kill_begin[component];
        const auto end = sequence.kill_order.begin() + sequence.kill_begin[component + 1];
        auto at = std::partition_point(
            begin, end, [&](std::uint32_t wedge) { return sequence.wedge_death[wedge] <= step; });
        while (at != begin) { // later deaths first: a parent is resolved before its children
            const std::uint32_t wedge = *--at;
            const std::uint32_t parent = sequence.wedge_parent[wedge];
            if (parent != kNone)
                out[wedge] = out[parent];
        }
    };
    if (out.size() <= kGrain)
        for (std::size_t c = 0; c < components; ++c)
            resolve(c);
    else
        tbb::parallel_for(std::size_t{0}, components, resolve);
}

glm::vec3 wedgePosition(const CollapseSequence& sequence,
                        const Submesh& submesh,
                        std::uint32_t wedge,
                        std::uint32_t step) {
    const std::uint32_t version = versionAt(sequence, wedge, step);
    if (version != kNone)
        return sequence.version_position[version];
    const auto after = std::ranges::upper_bound(sequence.complex.wedge_begin, wedge);
    const auto primitive =
        static_cast<std::size_t>(after - sequence.complex.wedge_begin.begin()) - 1;
    return submesh.primitives[primitive].geometry->positions[sequence.complex.wedge_source[wedge]];
}

std::vector<GeometryPtr> readOutSubmesh(const CollapseSequence& sequence,
                                        const Submesh& submesh,
                                        std::uint32_t step,
                                        double scale,
                                        const glm::dvec3& pivot) {
    ReadOut read = readingAt(sequence, submesh, step, scale, pivot);
    std::vector<GeometryPtr> primitives;
    for (std::size_t p = 0; p < submesh.primitives.size(); ++p)
        primitives.push_back(read.readPrimitive(p));
    return primitives;
}

std::vector<GeometryPtr> readOutEnds(const CollapseSequence& sequence,
                                     const Submesh& submesh,
                                     const StepRange& steps,
                                     double scale,
                                     const glm::dvec3& pivot) {
    ReadOut fine = readingAt(sequence, submesh, steps.fine, 1.0, pivot);
    const ReadOut coarse = readingAt(sequence, submesh, steps.coarse, scale, pivot);
    std::vector<GeometryPtr> primitives;
    for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
        if (submesh.primitives[p].mode != PrimitiveMode::Triangles) {
            primitives.push_back(submesh.primitives[p].geometry);
            continue;
        }
        AliveWedges wedges = fine.findAlive(p);
        for (std::size_t i = 0; i < wedges.wedges.size(); ++i) {
            wedges.wedges[i] = coarse.stands_for[wedges.wedges[i]];
            wedges.versions[i] = versionAt(sequence, wedges.wedges[i], steps.coarse);
        }
        auto to = std::make_shared<Geometry>();
        coarse.fillVertices(p, wedges, *to);
        primitives.push_back(std::move(to));
    }
    return primitives;
}

} // namespace lodestone
