#include "scene/scene.h"

#include "scene/lod.h"
#include "scene/result.h"
#include "scene/transformed_box.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

namespace lodestone {

int exitCode(ErrorKind kind) {
    switch (kind) {
    case ErrorKind::Failed:
        return 1;
    case ErrorKind::Usage:
        return 2;
    case ErrorKind::BadInput:
        return 3;
    case ErrorKind::Cancelled:
        return 130;
    }
    return 1;
}

std::size_t byteSize(ComponentType type) {
    switch (type) {
    case ComponentType::Int8:
    case ComponentType::UInt8:
        return 1;
    case ComponentType::Int16:
    case ComponentType::UInt16:
        return 2;
    case ComponentType::UInt32:
    case ComponentType::Float32:
        return 4;
    }
    return 4;
}

namespace {

template <class T>
float readAs(const std::byte* from, float scale) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return std::max(static_cast<float>(value) / scale, -1.0f);
}

template <class T>
void writeAs(std::byte* to, float value, float scale) {
    const double low = static_cast<double>(std::numeric_limits<T>::lowest());
    const double high = static_cast<double>(std::numeric_limits<T>::max());
    const double scaled = std::nearbyint(static_cast<double>(value) * static_cast<double>(scale));
    const T stored = static_cast<T>(std::clamp(scaled, low, high));
    std::memcpy(to, &stored, sizeof stored);
}

template <class T>
float decode(const std::byte* from, bool normalized) {
    if (normalized)
        return readAs<T>(from, static_cast<float>(std::numeric_limits<T>::max()));
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<float>(value);
}

template <class T>
void encode(std::byte* to, float value, bool normalized) {
    writeAs<T>(to, value, normalized ? static_cast<float>(std::numeric_limits<T>::max()) : 1.0f);
}

} // namespace

float attributeValue(const Attribute& attribute, std::size_t vertex, std::size_t component) {
    const std::size_t at = vertex * attribute.stride() + component * byteSize(attribute.type);
    assert(at + byteSize(attribute.type) <= attribute.bytes.size());
    const std::byte* from = attribute.bytes.data() + at;
    switch (attribute.type) {
    case ComponentType::Int8:
        return decode<std::int8_t>(from, attribute.normalized);
    case ComponentType::UInt8:
        return decode<std::uint8_t>(from, attribute.normalized);
    case ComponentType::Int16:
        return decode<std::int16_t>(from, attribute.normalized);
    case ComponentType::UInt16:
        return decode<std::uint16_t>(from, attribute.normalized);
    case ComponentType::UInt32:
        return decode<std::uint32_t>(from, attribute.normalized);
    case ComponentType::Float32: {
        float value;
        std::memcpy(&value, from, sizeof value);
        return value;
    }
    }
    return 0.0f;
}

void setAttributeValue(Attribute& attribute,
                       std::size_t vertex,
                       std::size_t component,
                       float value) {
    const std::size_t at = vertex * attribute.stride() + component * byteSize(attribute.type);
    assert(at + byteSize(attribute.type) <= attribute.bytes.size());
    std::byte* to = attribute.bytes.data() + at;
    switch (attribute.type) {
    case ComponentType::Int8:
        return encode<std::int8_t>(to, value, attribute.normalized);
    case ComponentType::UInt8:
        return encode<std::uint8_t>(to, value, attribute.normalized);
    case ComponentType::Int16:
        return encode<std::int16_t>(to, value, attribute.normalized);
    case ComponentType::UInt16:
        return encode<std::uint16_t>(to, value, attribute.normalized);
    case ComponentType::UInt32:
        return encode<std::uint32_t>(to, value, attribute.normalized);
    case ComponentType::Float32:
        std::memcpy(to, &value, sizeof value);
        return;
    }
}

const Attribute* findAttribute(std::span<const Attribute> attributes, std::string_view semantic) {
    const auto found = std::ranges::find_if(
        attributes, [&](const Attribute& a) { return a.semantic == semantic; });
    return found == attributes.end() ? nullptr : &*found;
}

std::vector<InstanceRange> instanceRanges(const Scene& scene) {
    std::vector<InstanceRange> ranges(scene.submeshes.size());
    std::uint32_t at = 0;
    for (std::uint32_t s = 0; s < ranges.size(); ++s) {
        ranges[s].begin = at;
        while (at < scene.instances.size() && scene.instances[at].submesh == s)
            ++at;
        ranges[s].end = at;
    }
    assert(at == scene.instances.size() && "instances are sorted by submesh");
    return ranges;
}

std::uint64_t triangleCount(const Submesh& submesh) {
    std::uint64_t count = 0;
    for (const Primitive& primitive : submesh.primitives)
        if (primitive.mode == PrimitiveMode::Triangles)
            count += primitive.geometry->triangleCount();
    return count;
}

SceneCounts countScene(const Scene& scene) {
    SceneCounts counts;
    counts.instances = scene.instances.size();
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s) {
        if (ranges[s].size() == 0)
            continue;
        ++counts.submeshes;
        const std::uint64_t triangles = triangleCount(scene.submeshes[s]);
        counts.unique_triangles += triangles;
        counts.triangles += triangles * ranges[s].size();
        for (const Primitive& primitive : scene.submeshes[s].primitives)
            counts.vertices += primitive.geometry->positions.size();
    }
    return counts;
}

void Bounds::add(const glm::dvec3& point) {
    min = empty ? point : glm::min(min, point);
    max = empty ? point : glm::max(max, point);
    empty = false;
}

double Bounds::diagonal() const {
    return empty ? 0.0 : glm::length(max - min);
}

Bounds localBounds(const Submesh& submesh) {
    Bounds bounds;
    for (const Primitive& primitive : submesh.primitives)
        for (const glm::vec3& position : primitive.geometry->positions)
            bounds.add(glm::dvec3(position));
    return bounds;
}

namespace {

Bounds joined(Bounds a, const Bounds& b) {
    if (!b.empty) {
        a.add(b.min);
        a.add(b.max);
    }
    return a;
}

bool contains(const Bounds& outer, const Bounds& inner) {
    return !outer.empty && glm::all(glm::lessThanEqual(outer.min, inner.min)) &&
           glm::all(glm::greaterThanEqual(outer.max, inner.max));
}

// Bounds of every instanced vertex that lies within `limit` of `origin` (no limit if negative).
// Only instances whose box sticks out of the bounds so far are looked at closely: a few in a
// hundred.
Bounds boundsWithin(const Scene& scene, const glm::dvec3& origin, double limit) {
    std::vector<Bounds> boxes(scene.submeshes.size());
    tbb::parallel_for(std::size_t{0}, boxes.size(), [&](std::size_t s) {
        boxes[s] = localBounds(scene.submeshes[s]);
    });
    const auto add_instance = [&](Bounds& bounds, const Instance& instance) {
        const Bounds& box = boxes[instance.submesh];
        if (box.empty || contains(bounds, transformedBox(instance.transform, box)))
            return;
        for (const Primitive& primitive : scene.submeshes[instance.submesh].primitives)
            for (const glm::vec3& position : primitive.geometry->positions) {
                const glm::dvec3 world(instance.transform * glm::dvec4(glm::dvec3(position), 1.0));
                if (limit < 0.0 || glm::length(world - origin) <= limit)
                    bounds.add(world);
            }
    };
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, scene.instances.size(), 1024),
        Bounds{},
        [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
            for (std::size_t i = range.begin(); i != range.end(); ++i)
                add_instance(bounds, scene.instances[i]);
            return bounds;
        },
        joined);
}

// The middle value of up to 4,096 evenly taken instanced vertices, per axis: where the bulk is.
struct Bulk {
    glm::dvec3 median{0.0};
    double spread = 0.0; // the larger axis' distance between its 5 % and 95 % quantile
};

Bulk findBulk(const Scene& scene) {
    std::vector<glm::dvec3> points;
    const std::size_t instance_step = scene.instances.size() / 256 + 1;
    for (std::size_t i = 0; i < scene.instances.size(); i += instance_step) {
        const Instance& instance = scene.instances[i];
        for (const Primitive& primitive : scene.submeshes[instance.submesh].primitives) {
            const std::vector<glm::vec3>& positions = primitive.geometry->positions;
            const std::size_t step = positions.size() / 16 + 1;
            for (std::size_t v = 0; v < positions.size(); v += step)
                points.emplace_back(instance.transform * glm::dvec4(glm::dvec3(positions[v]), 1.0));
        }
    }
    Bulk bulk;
    if (points.empty())
        return bulk;
    std::vector<double> values(points.size());
    for (int axis = 0; axis < 3; ++axis) {
        std::ranges::transform(
            points, values.begin(), [&](const glm::dvec3& p) { return p[axis]; });
        std::ranges::sort(values);
        bulk.median[axis] = values[values.size() / 2];
        const double low = values[values.size() / 20];
        const double high = values[values.size() - 1 - values.size() / 20];
        bulk.spread = std::max(bulk.spread, high - low);
    }
    return bulk;
}

} // namespace

Bounds worldBounds(const Scene& scene) {
    return boundsWithin(scene, glm::dvec3(0.0), -1.0);
}

Bounds robustWorldBounds(const Scene& scene) {
    const Bounds all = worldBounds(scene);
    const Bulk bulk = findBulk(scene);
    if (bulk.spread <= 0.0 || all.diagonal() <= 1e6 * bulk.spread)
        return all;
    return boundsWithin(scene, bulk.median, 1e6 * bulk.spread);
}

Lod fullLod(const Scene& scene) {
    Lod lod;
    const std::vector<InstanceRange> ranges = instanceRanges(scene);
    lod.submeshes.resize(scene.submeshes.size());
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s) {
        for (const Primitive& primitive : scene.submeshes[s].primitives)
            lod.submeshes[s].primitives.push_back(primitive.geometry);
        lod.submeshes[s].kept_instances = ranges[s].size();
    }
    const SceneCounts counts = countScene(scene);
    lod.triangles = counts.triangles;
    lod.unique_triangles = counts.unique_triangles;
    lod.instances = counts.instances;
    return lod;
}

LodShape shapeOf(const Scene& scene, const Lod& lod) {
    LodShape shape;
    shape.submeshes.resize(lod.submeshes.size());
    for (std::size_t s = 0; s < lod.submeshes.size(); ++s) {
        LodShape::SubmeshShape& to = shape.submeshes[s];
        to.kept_instances = lod.submeshes[s].kept_instances;
        to.instance_order = lod.submeshes[s].instance_order;
        for (std::size_t p = 0; p < lod.submeshes[s].primitives.size(); ++p) {
            const GeometryPtr& geometry = lod.submeshes[s].primitives[p];
            to.primitives.push_back({static_cast<std::uint32_t>(geometry->positions.size()),
                                     static_cast<std::uint32_t>(geometry->indices.size())});
            to.changed |= geometry != scene.submeshes[s].primitives[p].geometry;
        }
    }
    return shape;
}

} // namespace lodestone
