#include "scene/gltf/writer_geometry.h"

#include "scene/finite.h"
#include "scene/gltf/writer_weights.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace lodestone {

namespace {

std::size_t paddedTo4(std::size_t size) {
    return (size + 3) & ~std::size_t{3};
}

const Geometry& geometryOf(const AccessorLayout& accessor, const Lod& lod) {
    return *lod.submeshes[accessor.submesh].primitives[accessor.primitive];
}

const Attribute& attributeOf(const StreamPlan& stream, const Geometry& geometry) {
    return stream.target == kNone
               ? geometry.attributes[stream.attribute]
               : geometry.morph_targets[stream.target].attributes[stream.attribute];
}

// Positions as the file stores them; not for floats.
Attribute
storedPositions(const ExportPlan& plan, const AccessorLayout& accessor, const Geometry& geometry) {
    const PositionGrid& grid = plan.grids[accessor.submesh];
    Attribute attribute;
    attribute.type = accessor.stream->stored.type;
    attribute.normalized = accessor.stream->stored.normalized;
    attribute.components = 3;
    attribute.bytes.resize(geometry.positions.size() * attribute.stride());
    for (std::size_t v = 0; v < geometry.positions.size(); ++v)
        for (int c = 0; c < 3; ++c) {
            double value = static_cast<double>(geometry.positions[v][c]);
            if (grid.step > 0.0)
                value = (value - grid.offset[c]) / grid.step;
            setAttributeValue(attribute, v, static_cast<std::size_t>(c), static_cast<float>(value));
        }
    return attribute;
}

template <class T>
void widen(std::span<const std::byte> bytes, std::size_t components, AccessorBounds& bounds) {
    const std::size_t count = bytes.size() / sizeof(T);
    for (std::size_t i = 0; i < count; ++i) {
        T value;
        std::memcpy(&value, bytes.data() + i * sizeof(T), sizeof value);
        const std::size_t c = i % components;
        const auto number = static_cast<float>(value);
        bounds.min[c] = i < components ? number : std::min(bounds.min[c], number);
        bounds.max[c] = i < components ? number : std::max(bounds.max[c], number);
    }
}

AccessorBounds
boundsOfBytes(std::span<const std::byte> bytes, ComponentType type, std::size_t components) {
    AccessorBounds bounds;
    switch (type) {
    case ComponentType::Int8:
        widen<std::int8_t>(bytes, components, bounds);
        break;
    case ComponentType::UInt8:
        widen<std::uint8_t>(bytes, components, bounds);
        break;
    case ComponentType::Int16:
        widen<std::int16_t>(bytes, components, bounds);
        break;
    case ComponentType::UInt16:
        widen<std::uint16_t>(bytes, components, bounds);
        break;
    case ComponentType::UInt32:
        widen<std::uint32_t>(bytes, components, bounds);
        break;
    case ComponentType::Float32:
        widen<float>(bytes, components, bounds);
        break;
    }
    return bounds;
}

// No reader copes with NaN: zero instead.
void replaceNotFinite(std::span<std::byte> bytes) {
    for (std::size_t at = 0; at + sizeof(float) <= bytes.size(); at += sizeof(float)) {
        float value;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        if (std::isfinite(value))
            continue;
        value = 0.0f;
        std::memcpy(bytes.data() + at, &value, sizeof value);
    }
}

std::vector<std::byte> padElements(std::span<const std::byte> bytes, std::size_t element_bytes) {
    const std::size_t stride = paddedTo4(element_bytes);
    const std::size_t count = bytes.size() / element_bytes;
    std::vector<std::byte> padded(count * stride);
    if (stride == element_bytes) {
        std::ranges::copy(bytes, padded.begin());
        return padded;
    }
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(padded.data() + i * stride, bytes.data() + i * element_bytes, element_bytes);
    return padded;
}

std::vector<std::byte> indexBytes(const AccessorLayout& accessor, const Geometry& geometry) {
    const bool wide = accessor.view_class == kIndex32Class;
    std::vector<std::byte> bytes(paddedTo4(geometry.indices.size() * (wide ? 4 : 2)));
    if (wide) {
        std::memcpy(bytes.data(), geometry.indices.data(), geometry.indices.size() * 4);
        return bytes;
    }
    for (std::size_t i = 0; i < geometry.indices.size(); ++i) {
        const auto index = static_cast<std::uint16_t>(geometry.indices[i]);
        std::memcpy(bytes.data() + i * sizeof index, &index, sizeof index);
    }
    return bytes;
}

bool sameFormat(const Attribute& a, const Attribute& b, std::size_t vertex_count) {
    return a.semantic == b.semantic && a.type == b.type && a.components == b.components &&
           a.normalized == b.normalized && a.bytes.size() == vertex_count * a.stride();
}

bool sameFormats(std::span<const Attribute> a, std::span<const Attribute> b, std::size_t vertices) {
    return std::ranges::equal(
        a, b, [&](const Attribute& x, const Attribute& y) { return sameFormat(x, y, vertices); });
}

// What is wrong with a primitive of a LOD; empty if nothing is.
std::string faultOf(const Geometry& geometry, const Geometry& original) {
    const std::size_t vertices = geometry.positions.size();
    if (!sameFormats(geometry.attributes, original.attributes, vertices) ||
        geometry.morph_targets.size() != original.morph_targets.size())
        return "its attributes differ from the scene's";
    for (std::size_t t = 0; t < geometry.morph_targets.size(); ++t)
        if (!sameFormats(geometry.morph_targets[t].attributes,
                         original.morph_targets[t].attributes,
                         vertices))
            return "its morph targets differ from the scene's";
    if (!std::ranges::all_of(geometry.positions, [](const glm::vec3& p) { return isFinite(p); }))
        return "a position is not finite";
    if (std::ranges::any_of(geometry.indices, [&](std::uint32_t i) { return i >= vertices; }))
        return "an index is out of range";
    return {};
}

} // namespace

Result<void> checkLod(const ExportPlan& plan, const Lod& lod) {
    const Scene& scene = plan.scene;
    if (lod.submeshes.size() != scene.submeshes.size())
        return fail(ErrorKind::Failed, scene.name + ": the level of detail is of another scene");
    for (std::size_t s = 0; s < scene.submeshes.size(); ++s) {
        const Submesh& submesh = scene.submeshes[s];
        if (lod.submeshes[s].primitives.size() != submesh.primitives.size())
            return fail(ErrorKind::Failed,
                        scene.name + ": the level of detail is of another scene");
        for (std::size_t p = 0; p < submesh.primitives.size(); ++p) {
            const GeometryPtr& geometry = lod.submeshes[s].primitives[p];
            const std::string fault = faultOf(*geometry, *submesh.primitives[p].geometry);
            if (!fault.empty())
                return fail(ErrorKind::Failed,
                            scene.name + ": submesh " + std::to_string(s) + " (" + submesh.name +
                                "), primitive " + std::to_string(p) + ": " + fault);
        }
    }
    return {};
}

AccessorBounds boundsOf(const ExportPlan& plan, const AccessorLayout& accessor, const Lod& lod) {
    if (accessor.stream == nullptr || accessor.stream->bounds_width == 0)
        return {};
    const Geometry& geometry = geometryOf(accessor, lod);
    const StoredType& stored = accessor.stream->stored;
    if (accessor.stream->attribute != kNone) {
        const Attribute attribute =
            storedAttribute(attributeOf(*accessor.stream, geometry), stored);
        return boundsOfBytes(attribute.bytes, attribute.type, attribute.components);
    }
    if (stored.type == ComponentType::Float32)
        return boundsOfBytes(
            std::as_bytes(std::span(geometry.positions)), ComponentType::Float32, 3);
    return boundsOfBytes(storedPositions(plan, accessor, geometry).bytes, stored.type, 3);
}

std::vector<std::byte>
accessorBytes(const ExportPlan& plan, const AccessorLayout& accessor, const Lod& lod) {
    const Geometry& geometry = geometryOf(accessor, lod);
    if (accessor.stream == nullptr)
        return indexBytes(accessor, geometry);
    const StoredType& stored = accessor.stream->stored;
    if (accessor.stream->attribute == kNone) {
        if (stored.type == ComponentType::Float32)
            return padElements(std::as_bytes(std::span(geometry.positions)), sizeof(glm::vec3));
        const Attribute attribute = storedPositions(plan, accessor, geometry);
        return padElements(attribute.bytes, attribute.stride());
    }
    const Primitive& primitive =
        plan.scene.submeshes[accessor.submesh].primitives[accessor.primitive];
    const Attribute& attribute = attributeOf(*accessor.stream, geometry);
    const bool simplified = primitive.geometry.get() != &geometry;
    const bool weighs =
        accessor.stream->target == kNone && attribute.semantic.starts_with("WEIGHTS_");
    const Attribute written = simplified && weighs ? normalizedWeights(geometry, attribute)
                                                   : storedAttribute(attribute, stored);
    std::vector<std::byte> bytes = padElements(written.bytes, written.stride());
    if (written.type == ComponentType::Float32)
        replaceNotFinite(bytes);
    return bytes;
}

std::vector<std::vector<std::byte>>
rowBytes(const ExportPlan& plan, const Layout& layout, const Lod& lod, std::uint32_t group) {
    std::vector<std::vector<std::byte>> lists;
    if (layout.groups[group].rows == 0)
        return lists;
    const GroupPlan& from = plan.groups[group];
    const LodSubmesh& submesh = lod.submeshes[from.submesh];
    LodShape::SubmeshShape shape;
    shape.kept_instances = submesh.kept_instances;
    shape.instance_order = submesh.instance_order;
    std::vector<std::uint32_t> rows;
    forEachKept(plan.submeshes[from.submesh].range, shape, [&](std::uint32_t i) {
        if (plan.instances[i].group == group)
            rows.push_back(plan.instances[i].row);
    });
    std::ranges::sort(rows);
    for (std::size_t a = 0; a < from.attributes.size(); ++a) {
        const GroupAttribute& attribute = from.stored(a, layout.groups[group].coarse);
        std::vector<std::byte> bytes;
        for (const std::uint32_t row : rows) {
            const auto at =
                attribute.bytes.begin() + static_cast<std::ptrdiff_t>(row * attribute.row_bytes);
            bytes.insert(bytes.end(), at, at + static_cast<std::ptrdiff_t>(attribute.row_bytes));
        }
        bytes.resize(paddedTo4(bytes.size()));
        lists.push_back(std::move(bytes));
    }
    return lists;
}

} // namespace lodestone
