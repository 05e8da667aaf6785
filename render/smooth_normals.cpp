#include "render/smooth_normals.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace lodestone {

namespace {

constexpr double kCreaseCosine = 0.5;     // of 60 degrees
constexpr float kSameNormal = 0.9999f;    // cosine; closer ones share a vertex
constexpr std::uint32_t kMostPairs = 256; // faces around a point that are compared pair by pair

std::uint64_t hashOf(const glm::vec3& position, std::uint32_t block) {
    std::uint64_t hash = block * 0x9E3779B97F4A7C15ull;
    for (int c = 0; c < 3; ++c) {
        // -0.0 equals 0.0
        hash ^= std::bit_cast<std::uint32_t>(position[c] + 0.0f);
        hash *= 0xFF51AFD7ED558CCDull;
        hash ^= hash >> 32u;
    }
    return hash;
}

// points[v]: number of the point where vertex v is.
struct Welded {
    std::vector<std::uint32_t> points;
    std::uint32_t point_count = 0;
};

Welded weld(const Geometry& geometry) {
    const std::vector<glm::vec3>& positions = geometry.positions;
    Welded welded;
    welded.points.resize(positions.size());
    const std::size_t slots = std::bit_ceil(positions.size() * 2 + 1);
    std::vector<std::uint32_t> table(slots, kNone); // first vertex at a point
    std::uint32_t block = 0;
    std::uint32_t block_begin = 0;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        while (block < geometry.weld_blocks.size() && geometry.weld_blocks[block] <= v)
            block_begin = geometry.weld_blocks[block++];
        std::size_t slot = hashOf(positions[v], block) & (slots - 1);
        while (table[slot] != kNone &&
               (table[slot] < block_begin || positions[table[slot]] != positions[v]))
            slot = (slot + 1) & (slots - 1);
        if (table[slot] == kNone) {
            table[slot] = v;
            welded.points[v] = welded.point_count++;
        } else {
            welded.points[v] = welded.points[table[slot]];
        }
    }
    return welded;
}

struct Face {
    glm::dvec3 normal{0.0}; // twice the area long
    double length = 0.0;
};

std::vector<Face> facesOf(const Geometry& geometry) {
    std::vector<Face> faces(geometry.triangleCount());
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const glm::dvec3 a(geometry.positions[geometry.indices[3 * f]]);
        const glm::dvec3 b(geometry.positions[geometry.indices[3 * f + 1]]);
        const glm::dvec3 c(geometry.positions[geometry.indices[3 * f + 2]]);
        faces[f].normal = glm::cross(b - a, c - a);
        faces[f].length = glm::length(faces[f].normal);
    }
    return faces;
}

// Corners (places in indices) by the point they are at.
struct CornerLists {
    std::vector<std::uint32_t> begin; // [points + 1]
    std::vector<std::uint32_t> corners;
};

CornerLists cornersByPoint(const Geometry& geometry, const Welded& welded) {
    const std::size_t corner_count = geometry.triangleCount() * 3;
    CornerLists lists;
    lists.begin.resize(std::size_t(welded.point_count) + 1, 0);
    for (std::size_t c = 0; c < corner_count; ++c)
        ++lists.begin[welded.points[geometry.indices[c]] + 1];
    for (std::size_t p = 1; p < lists.begin.size(); ++p)
        lists.begin[p] += lists.begin[p - 1];
    lists.corners.resize(corner_count);
    std::vector<std::uint32_t> next(lists.begin.begin(), lists.begin.end() - 1);
    for (std::uint32_t c = 0; c < corner_count; ++c)
        lists.corners[next[welded.points[geometry.indices[c]]]++] = c;
    return lists;
}

glm::vec3 unit(const glm::dvec3& sum) {
    const double length = glm::length(sum);
    return length > 0.0 && std::isfinite(length) ? glm::vec3(sum / length) : glm::vec3(0.0f);
}

std::vector<glm::vec3> cornerNormals(const CornerLists& lists, const std::vector<Face>& faces) {
    std::vector<glm::vec3> normals(lists.corners.size());
    const auto smooth = [&](std::size_t point) {
        const std::uint32_t begin = lists.begin[point];
        const std::uint32_t end = lists.begin[point + 1];
        const bool all = end - begin > kMostPairs;
        glm::dvec3 sum(0.0);
        for (std::uint32_t i = begin; all && i < end; ++i)
            sum += faces[lists.corners[i] / 3].normal;
        for (std::uint32_t i = begin; i < end; ++i) {
            const Face& face = faces[lists.corners[i] / 3];
            if (!all) {
                sum = glm::dvec3(0.0);
                for (std::uint32_t j = begin; j < end; ++j) {
                    const Face& other = faces[lists.corners[j] / 3];
                    if (glm::dot(face.normal, other.normal) >=
                        kCreaseCosine * face.length * other.length)
                        sum += other.normal;
                }
            }
            normals[lists.corners[i]] = unit(sum);
        }
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lists.begin.size() - 1, 4096),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t point = range.begin(); point < range.end(); ++point)
                              smooth(point);
                      });
    return normals;
}

// Vertices of the result: where each comes from, and its normal.
struct SplitVertices {
    std::vector<std::uint32_t> sources;
    std::vector<glm::vec3> normals;
    std::vector<std::uint32_t> indices;
};

SplitVertices splitVertices(const Geometry& geometry, const std::vector<glm::vec3>& normals) {
    SplitVertices split;
    split.sources.reserve(geometry.positions.size());
    split.normals.reserve(geometry.positions.size());
    split.indices.reserve(normals.size());
    std::vector<std::uint32_t> last(geometry.positions.size(), kNone); // of those made of a vertex
    std::vector<std::uint32_t> previous;                               // of the same vertex
    previous.reserve(geometry.positions.size());
    for (std::size_t c = 0; c < normals.size(); ++c) {
        const std::uint32_t source = geometry.indices[c];
        std::uint32_t found = last[source];
        while (found != kNone && normals[c] != split.normals[found] &&
               glm::dot(normals[c], split.normals[found]) < kSameNormal)
            found = previous[found];
        if (found == kNone) {
            found = static_cast<std::uint32_t>(split.sources.size());
            split.sources.push_back(source);
            split.normals.push_back(normals[c]);
            previous.push_back(last[source]);
            last[source] = found;
        }
        split.indices.push_back(found);
    }
    return split;
}

Attribute gathered(const Attribute& attribute, const std::vector<std::uint32_t>& sources) {
    Attribute result = attribute;
    const std::size_t stride = attribute.stride();
    result.bytes.assign(stride * sources.size(), std::byte(0));
    for (std::size_t v = 0; v < sources.size(); ++v)
        if ((std::size_t(sources[v]) + 1) * stride <= attribute.bytes.size())
            std::copy_n(&attribute.bytes[sources[v] * stride], stride, &result.bytes[v * stride]);
    return result;
}

} // namespace

Geometry withSmoothNormals(const Geometry& geometry) {
    const CornerLists lists = cornersByPoint(geometry, weld(geometry));
    SplitVertices split = splitVertices(geometry, cornerNormals(lists, facesOf(geometry)));
    Geometry result;
    result.positions.reserve(split.sources.size());
    for (const std::uint32_t source : split.sources)
        result.positions.push_back(geometry.positions[source]);
    for (const Attribute& attribute : geometry.attributes)
        result.attributes.push_back(gathered(attribute, split.sources));
    for (const MorphTarget& target : geometry.morph_targets) {
        result.morph_targets.emplace_back();
        for (const Attribute& attribute : target.attributes)
            result.morph_targets.back().attributes.push_back(gathered(attribute, split.sources));
    }
    Attribute normal;
    normal.semantic = "NORMAL";
    normal.bytes.resize(split.normals.size() * sizeof(glm::vec3));
    if (!split.normals.empty())
        std::memcpy(normal.bytes.data(), split.normals.data(), normal.bytes.size());
    result.attributes.push_back(std::move(normal));
    result.indices = std::move(split.indices);
    return result;
}

} // namespace lodestone
