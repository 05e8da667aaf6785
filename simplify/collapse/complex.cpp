#include "simplify/collapse/complex.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

namespace lodestone {

namespace {

std::uint32_t mix(std::uint32_t hash, std::uint32_t value) {
    hash ^= value;
    hash *= 0x9E3779B1u;
    return hash ^ (hash >> 15);
}

std::uint32_t hashPosition(const glm::vec3& p, std::uint32_t block) {
    std::uint32_t hash = mix(0x811C9DC5u, block);
    for (int axis = 0; axis < 3; ++axis)
        hash = mix(hash, std::bit_cast<std::uint32_t>(p[axis] + 0.0f)); // -0 + 0 = 0
    return hash;
}

// Open addressing table of ids, sized once.
class IdTable {
public:
    explicit IdTable(std::size_t capacity)
        : slots_(std::bit_ceil(std::max<std::size_t>(16, capacity * 2)), kNone) {}

    // The id already there that `equal` accepts, or `id` itself after storing it.
    template <class Equal>
    std::uint32_t findOrAdd(std::uint32_t hash, std::uint32_t id, Equal equal) {
        const std::size_t mask = slots_.size() - 1;
        for (std::size_t at = hash & mask;; at = (at + 1) & mask) {
            if (slots_[at] == kNone)
                return slots_[at] = id;
            if (equal(slots_[at]))
                return slots_[at];
        }
    }

private:
    std::vector<std::uint32_t> slots_;
};

// Block of each vertex of a primitive, walked in rising order.
class BlockCursor {
public:
    explicit BlockCursor(const std::vector<std::uint32_t>& starts) : starts_(starts) {}

    std::uint32_t at(std::uint32_t vertex) {
        while (next_ < starts_.size() && starts_[next_] <= vertex)
            ++next_;
        return next_;
    }

private:
    const std::vector<std::uint32_t>& starts_;
    std::uint32_t next_ = 0;
};

bool sameAttributes(const Geometry& geometry, std::uint32_t a, std::uint32_t b) {
    const auto same = [&](const Attribute& attribute) {
        const std::size_t stride = attribute.stride();
        return std::memcmp(attribute.bytes.data() + a * stride,
                           attribute.bytes.data() + b * stride,
                           stride) == 0;
    };
    return std::ranges::all_of(geometry.attributes, same) &&
           std::ranges::all_of(geometry.morph_targets, [&](const MorphTarget& target) {
               return std::ranges::all_of(target.attributes, same);
           });
}

struct Welder {
    Complex& complex;
    std::vector<std::uint32_t> blocks;      // [welded vertices]
    std::vector<std::uint32_t> first_wedge; // [welded vertices] of the current primitive
    std::vector<std::uint32_t> next_wedge;  // [wedges] others at the same place
    IdTable table;

    std::uint32_t weldVertex(const glm::vec3& p, std::uint32_t block) {
        const auto fresh = static_cast<std::uint32_t>(complex.positions.size());
        const std::uint32_t id =
            table.findOrAdd(hashPosition(p, block), fresh, [&](std::uint32_t other) {
                return complex.positions[other] == p && blocks[other] == block;
            });
        if (id == fresh) {
            complex.positions.push_back(p);
            blocks.push_back(block);
            first_wedge.push_back(kNone);
        }
        return id;
    }

    std::uint32_t addWedge(const Geometry& geometry,
                           std::uint32_t source,
                           std::uint32_t vertex,
                           std::uint32_t primitive_begin) {
        std::uint32_t* link = &first_wedge[vertex];
        while (*link != kNone && *link >= primitive_begin) {
            if (sameAttributes(geometry, complex.wedge_source[*link], source))
                return *link;
            link = &next_wedge[*link];
        }
        const auto wedge = static_cast<std::uint32_t>(complex.wedge_source.size());
        if (*link != kNone) { // an earlier primitive's list: start a new one
            first_wedge[vertex] = wedge;
        } else {
            *link = wedge;
        }
        complex.wedge_source.push_back(source);
        complex.wedge_vertex.push_back(vertex);
        next_wedge.push_back(kNone);
        return wedge;
    }
};

// True once every kCheckEvery rounds if the job is to stop: loops over millions look that often.
bool stopsAt(std::size_t round, const JobContext& job) {
    constexpr std::size_t kCheckEvery = 16'384;
    return round % kCheckEvery == 0 && job.stopRequested();
}

void addPrimitive(Welder& welder, const Geometry& geometry, const JobContext& job) {
    Complex& complex = welder.complex;
    const auto primitive_begin = static_cast<std::uint32_t>(complex.wedge_source.size());
    std::vector<std::uint32_t> wedge_of(geometry.positions.size(), kNone);
    std::vector<bool> used(geometry.positions.size(), false);
    for (const std::uint32_t index : geometry.indices)
        used[index] = true;
    BlockCursor cursor(geometry.weld_blocks);
    for (std::uint32_t v = 0; v < geometry.positions.size(); ++v) {
        if (stopsAt(v, job))
            return;
        if (!used[v])
            continue;
        const std::uint32_t vertex = welder.weldVertex(geometry.positions[v], cursor.at(v));
        wedge_of[v] = welder.addWedge(geometry, v, vertex, primitive_begin);
    }
    for (std::size_t t = 0; t < geometry.triangleCount(); ++t) {
        if (stopsAt(t, job))
            return;
        std::array<std::uint32_t, 3> face;
        for (std::size_t k = 0; k < 3; ++k)
            face[k] = wedge_of[geometry.indices[3 * t + k]];
        const std::uint32_t a = complex.wedge_vertex[face[0]];
        const std::uint32_t b = complex.wedge_vertex[face[1]];
        const std::uint32_t c = complex.wedge_vertex[face[2]];
        if (a == b || b == c || a == c)
            ++complex.dropped_faces;
        else
            complex.faces.push_back(face);
    }
}

// Removes faces that repeat another one of the same primitive: same vertices, same orientation.
// Faces are compared within the bucket of their smallest vertex.
void dropDoubles(Complex& complex, std::uint32_t begin, const JobContext& job) {
    if (job.stopRequested())
        return;
    const auto corners_of = [&](std::uint32_t f) {
        const std::uint32_t a = complex.wedge_vertex[complex.faces[f][0]];
        const std::uint32_t b = complex.wedge_vertex[complex.faces[f][1]];
        const std::uint32_t c = complex.wedge_vertex[complex.faces[f][2]];
        // No branch: which of them is the least cannot be foreseen.
        const std::size_t least = static_cast<std::size_t>((b < a) & (b < c)) +
                                  2 * static_cast<std::size_t>((c < a) & (c < b));
        const std::array twice{a, b, c, a, b};
        return std::array{twice[least], twice[least + 1], twice[least + 2]};
    };
    const auto end = static_cast<std::uint32_t>(complex.faces.size());
    std::vector<std::uint32_t> at(complex.positions.size() + 1, 0);
    for (std::uint32_t f = begin; f < end; ++f)
        ++at[corners_of(f)[0] + 1];
    std::partial_sum(at.begin(), at.end(), at.begin());
    if (job.stopRequested())
        return;

    struct Sides {
        std::uint32_t second = kNone;
        std::uint32_t third = kNone;
        bool operator==(const Sides&) const = default;
    };

    std::vector<Sides> bucket(end - begin); // filled from each bucket's front
    std::uint32_t kept = begin;
    for (std::uint32_t f = begin; f < end; ++f) {
        if (stopsAt(f, job))
            return;
        const auto [first, second, third] = corners_of(f);
        const Sides sides{second, third};
        std::uint32_t slot = at[first];
        while (bucket[slot] != sides && bucket[slot] != Sides{})
            ++slot;
        if (bucket[slot] == sides)
            continue;
        bucket[slot] = sides;
        complex.faces[kept++] = complex.faces[f];
    }
    complex.dropped_faces += end - kept;
    complex.faces.resize(kept);
}

std::uint32_t findRoot(std::vector<std::uint32_t>& parent, std::uint32_t v) {
    while (parent[v] != v) {
        parent[v] = parent[parent[v]];
        v = parent[v];
    }
    return v;
}

void findComponents(Complex& complex, const JobContext& job) {
    std::vector<std::uint32_t> parent(complex.positions.size());
    std::iota(parent.begin(), parent.end(), 0u);
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (stopsAt(f, job))
            return;
        const auto& face = complex.faces[f];
        std::uint32_t a = findRoot(parent, complex.wedge_vertex[face[0]]);
        for (std::size_t k = 1; k < 3; ++k) {
            const std::uint32_t b = findRoot(parent, complex.wedge_vertex[face[k]]);
            parent[std::max(a, b)] = std::min(a, b);
            a = std::min(a, b);
        }
    }
    std::vector<std::uint32_t> component_of_root(complex.positions.size(), kNone);
    std::vector<std::uint32_t> component_of_face(complex.faces.size());
    std::vector<std::uint32_t> counts;
    for (std::size_t f = 0; f < complex.faces.size(); ++f) {
        if (stopsAt(f, job))
            return;
        const std::uint32_t root = findRoot(parent, complex.wedge_vertex[complex.faces[f][0]]);
        if (component_of_root[root] == kNone) {
            component_of_root[root] = static_cast<std::uint32_t>(counts.size());
            counts.push_back(0);
        }
        component_of_face[f] = component_of_root[root];
        ++counts[component_of_face[f]];
    }
    complex.component_begin.assign(counts.size() + 1, 0);
    std::partial_sum(counts.begin(), counts.end(), complex.component_begin.begin() + 1);
    complex.component_faces.resize(complex.faces.size());
    std::vector<std::uint32_t> at(complex.component_begin.begin(),
                                  complex.component_begin.end() - 1);
    for (std::uint32_t f = 0; f < complex.faces.size(); ++f)
        complex.component_faces[at[component_of_face[f]]++] = f;
}

} // namespace

std::size_t Complex::primitiveOfFace(std::uint32_t face) const {
    const auto after = std::ranges::upper_bound(face_begin, face);
    return static_cast<std::size_t>(after - face_begin.begin()) - 1;
}

Complex buildComplex(const Submesh& submesh, const JobContext& job) {
    Complex complex;
    std::size_t vertex_count = 0;
    for (const Primitive& primitive : submesh.primitives)
        vertex_count += primitive.geometry->positions.size();
    Welder welder{complex, {}, {}, {}, IdTable(vertex_count)};
    complex.wedge_begin.push_back(0);
    complex.face_begin.push_back(0);
    for (const Primitive& primitive : submesh.primitives) {
        if (primitive.mode == PrimitiveMode::Triangles) {
            const auto begin = static_cast<std::uint32_t>(complex.faces.size());
            addPrimitive(welder, *primitive.geometry, job);
            dropDoubles(complex, begin, job);
        }
        complex.wedge_begin.push_back(static_cast<std::uint32_t>(complex.wedge_source.size()));
        complex.face_begin.push_back(static_cast<std::uint32_t>(complex.faces.size()));
    }
    if (job.stopRequested())
        return complex;
    findComponents(complex, job);
    if (job.stopRequested())
        return complex;
    complex.bulk = findBulk(complex.positions);
    return complex;
}

} // namespace lodestone
