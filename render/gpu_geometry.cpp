#include "render/gpu_geometry.h"

#include "render/renderer_state.h"
#include "render/smooth_normals.h"
#include "scene/vertex_value.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>

namespace lodestone {

namespace {

constexpr std::size_t kFrameSamples = 4096;
constexpr double kFarthest = 1e15; // local units; beyond, products overflow a float

double median(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

const Attribute* usable(const Geometry& geometry, std::string_view semantic, int components) {
    const Attribute* attribute = findAttribute(geometry.attributes, semantic);
    if (attribute == nullptr || attribute->components < components ||
        attribute->bytes.size() < attribute->stride() * geometry.positions.size())
        return nullptr;
    return attribute;
}

float finite(float value) {
    return std::isfinite(value) ? value : 0.0f;
}

// Writes the first `components` components of an attribute as floats into interleaved vertices.
struct Interleaved {
    std::span<std::byte> bytes;
    std::size_t stride = 0;
    std::size_t offset = 0;
};

void putFloats(const Interleaved& out, const Attribute& attribute, std::size_t components) {
    const std::size_t count = out.bytes.size() / out.stride;
    const bool copy = attribute.type == ComponentType::Float32;
    for (std::size_t v = 0; v < count; ++v) {
        float values[4] = {0.0f, 0.0f, 0.0f, 0.0f};
        if (copy)
            std::memcpy(
                values, &attribute.bytes[v * attribute.stride()], components * sizeof(float));
        else
            for (std::size_t c = 0; c < components; ++c)
                values[c] = attributeValue(attribute, v, c);
        for (std::size_t c = 0; c < components; ++c)
            values[c] = finite(values[c]);
        std::memcpy(&out.bytes[v * out.stride + out.offset], values, components * sizeof(float));
    }
}

void putColors(const Interleaved& out, const Attribute& attribute) {
    const std::size_t count = out.bytes.size() / out.stride;
    for (std::size_t v = 0; v < count; ++v) {
        std::uint16_t values[4] = {0, 0, 0, 65535};
        for (std::size_t c = 0; c < std::min<std::size_t>(attribute.components, 4); ++c) {
            const float value = std::clamp(finite(attributeValue(attribute, v, c)), 0.0f, 1.0f);
            values[c] = static_cast<std::uint16_t>(std::lround(value * 65535.0f));
        }
        std::memcpy(&out.bytes[v * out.stride + out.offset], values, sizeof values);
    }
}

void putPositions(const Interleaved& out, const Geometry& geometry, const LocalFrame& frame) {
    const double inverse = 1.0 / frame.scale;
    for (std::size_t v = 0; v < geometry.positions.size(); ++v) {
        const glm::dvec3 local = (glm::dvec3(geometry.positions[v]) - frame.center) * inverse;
        const glm::vec3 position(glm::clamp(local, glm::dvec3(-kFarthest), glm::dvec3(kFarthest)));
        std::memcpy(&out.bytes[v * out.stride + out.offset], &position, sizeof position);
    }
}

template <class Index>
std::vector<std::byte> indexBytes(const Geometry& geometry) {
    std::vector<std::byte> bytes(geometry.indices.size() * sizeof(Index));
    for (std::size_t at = 0; at < geometry.indices.size(); ++at) {
        const auto index = static_cast<Index>(geometry.indices[at]);
        std::memcpy(&bytes[at * sizeof(Index)], &index, sizeof(Index));
    }
    return bytes;
}

void packIndices(const Geometry& geometry, PackedGeometry& packed) {
    constexpr std::size_t kNarrowVertices = 65536;
    packed.index_count = static_cast<std::uint32_t>(geometry.indices.size());
    const bool narrow = geometry.positions.size() <= kNarrowVertices;
    packed.index_type = narrow ? GL_UNSIGNED_SHORT : GL_UNSIGNED_INT;
    packed.indices =
        narrow ? indexBytes<std::uint16_t>(geometry) : indexBytes<std::uint32_t>(geometry);
}

GlBuffer reserveBuffer(std::size_t size_bytes) {
    GlBuffer buffer = GlBuffer::create();
    // Not GL_ELEMENT_ARRAY_BUFFER: that would change whatever vertex array is bound.
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    glBufferData(
        GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(size_bytes), nullptr, GL_STATIC_DRAW);
    return buffer;
}

} // namespace

LocalFrame localFrame(const Submesh& submesh) {
    std::size_t vertex_count = 0;
    for (const Primitive& primitive : submesh.primitives)
        vertex_count += primitive.geometry->positions.size();
    const std::size_t step = vertex_count / kFrameSamples + 1;
    std::vector<double> axis[3];
    std::size_t index = 0;
    for (const Primitive& primitive : submesh.primitives)
        for (const glm::vec3& position : primitive.geometry->positions)
            if (index++ % step == 0)
                for (int c = 0; c < 3; ++c)
                    axis[c].push_back(position[c]);
    LocalFrame frame;
    if (axis[0].empty())
        return frame;
    double scale = 0.0;
    for (int c = 0; c < 3; ++c) {
        frame.center[c] = median(axis[c]);
        for (double& value : axis[c])
            value = std::abs(value - frame.center[c]);
        scale = std::max(scale, median(axis[c]));
    }
    if (scale > 0.0 && std::isfinite(scale))
        frame.scale = scale;
    return frame;
}

namespace {

// Fills vertices and layout.
void packVertices(const Geometry& geometry, const LocalFrame& frame, PackedGeometry& packed) {
    const Attribute* normal = usable(geometry, "NORMAL", 3);
    const Attribute* uv0 = usable(geometry, "TEXCOORD_0", 2);
    const Attribute* uv1 = usable(geometry, "TEXCOORD_1", 2);
    const Attribute* color = usable(geometry, "COLOR_0", 3);
    const Attribute* value = usable(geometry, kVertexValueSemantic, 1);
    VertexLayout& layout = packed.layout;
    std::size_t stride = sizeof(glm::vec3);
    const auto reserve = [&](const Attribute* attribute, Feature feature, std::size_t size_bytes) {
        const std::size_t offset = stride;
        if (attribute != nullptr) {
            layout.features |= feature;
            stride += size_bytes;
        }
        return offset;
    };
    layout.normal_offset = reserve(normal, kHasNormal, sizeof(glm::vec3));
    layout.uv0_offset = reserve(uv0, kHasUv0, sizeof(glm::vec2));
    layout.uv1_offset = reserve(uv1, kHasUv1, sizeof(glm::vec2));
    layout.color_offset = reserve(color, kHasColor, 4 * sizeof(std::uint16_t));
    layout.value_offset = reserve(value, kHasValue, sizeof(float));
    layout.stride_bytes = static_cast<GLsizei>(stride);

    std::vector<std::byte> bytes(stride * geometry.positions.size());
    putPositions({bytes, stride, 0}, geometry, frame);
    if (normal != nullptr)
        putFloats({bytes, stride, layout.normal_offset}, *normal, 3);
    if (uv0 != nullptr)
        putFloats({bytes, stride, layout.uv0_offset}, *uv0, 2);
    if (uv1 != nullptr)
        putFloats({bytes, stride, layout.uv1_offset}, *uv1, 2);
    if (color != nullptr)
        putColors({bytes, stride, layout.color_offset}, *color);
    if (value != nullptr)
        putFloats({bytes, stride, layout.value_offset}, *value, 1);
    packed.vertices = std::move(bytes);
    packed.vertex_count = static_cast<std::uint32_t>(geometry.positions.size());
}

} // namespace

bool lacksNormals(const Geometry& geometry, PrimitiveMode mode) {
    return mode == PrimitiveMode::Triangles && usable(geometry, "NORMAL", 3) == nullptr;
}

PackedGeometry
packGeometry(const GeometryPtr& source, const LocalFrame& frame, PrimitiveMode mode) {
    PackedGeometry packed;
    packed.source = source;
    Bounds box;
    for (const glm::vec3& position : source->positions)
        box.add(glm::dvec3(position));
    packed.source_center = box.center();
    packed.source_radius = box.empty ? 0.0 : box.diagonal() * 0.5;
    const bool smooth = lacksNormals(*source, mode);
    const Geometry smoothed = smooth ? withSmoothNormals(*source) : Geometry();
    const Geometry& geometry = smooth ? smoothed : *source;
    packVertices(geometry, frame, packed);
    packIndices(geometry, packed);
    return packed;
}

std::shared_ptr<GpuGeometry> reserveGeometry(const PackedGeometry& packed) {
    auto gpu = std::make_shared<GpuGeometry>();
    gpu->source = packed.source;
    gpu->source_center = packed.source_center;
    gpu->source_radius = packed.source_radius;
    gpu->layout = packed.layout;
    gpu->index_type = packed.index_type;
    gpu->index_count = packed.index_count;
    gpu->vertex_count = packed.vertex_count;
    gpu->vertices = reserveBuffer(packed.vertices.size());
    if (!packed.indices.empty())
        gpu->indices = reserveBuffer(packed.indices.size());
    gpu->bytes = packed.vertices.size() + packed.indices.size();
    return gpu;
}

std::vector<InstanceRow> packInstances(const InstanceSource& source,
                                       const std::vector<std::uint32_t>* order) {
    const std::size_t count = order ? order->size() : source.range.size();
    std::vector<InstanceRow> rows(count);
    const LocalFrame& local = source.local_frame;
    const double linear_scale = local.scale / source.scene_frame.radius;
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t id =
            order ? (*order)[i] : source.range.begin + static_cast<std::uint32_t>(i);
        const glm::dmat4& world = source.scene.instances[id].transform;
        const glm::dmat3 linear = glm::dmat3(world) * linear_scale;
        const glm::dvec3 center(world * glm::dvec4(local.center, 1.0));
        const glm::dvec3 origin = (center - source.scene_frame.center) / source.scene_frame.radius;
        rows[i].id = id;
        for (int r = 0; r < 3; ++r) {
            const glm::vec4 row(linear[0][r], linear[1][r], linear[2][r], origin[r]);
            const bool is_finite = std::isfinite(row.x + row.y + row.z + row.w);
            rows[i].rows[r] = is_finite ? row : glm::vec4(0.0f);
        }
    }
    return rows;
}

std::shared_ptr<InstanceBuffer>
reserveInstances(std::shared_ptr<const std::vector<std::uint32_t>> order, std::uint32_t count) {
    auto buffer = std::make_shared<InstanceBuffer>();
    buffer->order = std::move(order);
    buffer->count = count;
    buffer->bytes = count * sizeof(InstanceRow);
    buffer->rows = reserveBuffer(buffer->bytes);
    return buffer;
}

std::size_t copyToBuffer(const GlBuffer& buffer,
                         std::span<const std::byte> bytes,
                         std::size_t begin,
                         std::size_t most) {
    const std::size_t count = std::min(most, bytes.size() - std::min(begin, bytes.size()));
    if (count == 0)
        return 0;
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    glBufferSubData(GL_COPY_WRITE_BUFFER,
                    static_cast<GLintptr>(begin),
                    static_cast<GLsizeiptr>(count),
                    &bytes[begin]);
    return count;
}

void pointAtInstances(const InstanceBuffer& instances, std::uint32_t first) {
    const std::size_t begin = std::size_t(first) * sizeof(InstanceRow);
    glBindBuffer(GL_ARRAY_BUFFER, instances.rows.name());
    for (GLuint row = 0; row < 3; ++row)
        glVertexAttribPointer(
            5 + row,
            4,
            GL_FLOAT,
            GL_FALSE,
            sizeof(InstanceRow),
            // NOLINTNEXTLINE(performance-no-int-to-ptr): the library takes a number as a pointer
            reinterpret_cast<const void*>(begin + row * sizeof(glm::vec4)));
    glVertexAttribIPointer(
        8,
        1,
        GL_UNSIGNED_INT,
        sizeof(InstanceRow),
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the library takes a number as a pointer
        reinterpret_cast<const void*>(begin + offsetof(InstanceRow, id)));
}

GlVertexArray makeVertexArray(const GpuGeometry& geometry, const InstanceBuffer& instances) {
    GlVertexArray array = GlVertexArray::create();
    glBindVertexArray(array.name());
    glBindBuffer(GL_ARRAY_BUFFER, geometry.vertices.name());
    const VertexLayout& layout = geometry.layout;
    const auto attribute = [&](GLuint index, GLint size, GLenum type, std::size_t offset) {
        glEnableVertexAttribArray(index);
        glVertexAttribPointer(
            index,
            size,
            type,
            type == GL_FLOAT ? GL_FALSE : GL_TRUE,
            layout.stride_bytes,
            // NOLINTNEXTLINE(performance-no-int-to-ptr): the library takes a number as a pointer
            reinterpret_cast<const void*>(offset));
    };
    attribute(0, 3, GL_FLOAT, 0);
    if ((layout.features & kHasNormal) != 0)
        attribute(1, 3, GL_FLOAT, layout.normal_offset);
    if ((layout.features & kHasUv0) != 0)
        attribute(2, 2, GL_FLOAT, layout.uv0_offset);
    if ((layout.features & kHasUv1) != 0)
        attribute(3, 2, GL_FLOAT, layout.uv1_offset);
    if ((layout.features & kHasColor) != 0)
        attribute(4, 4, GL_UNSIGNED_SHORT, layout.color_offset);
    if ((layout.features & kHasValue) != 0)
        attribute(9, 1, GL_FLOAT, layout.value_offset);

    pointAtInstances(instances, 0);
    for (GLuint index = 5; index <= 8; ++index) {
        glEnableVertexAttribArray(index);
        glVertexAttribDivisor(index, 1);
    }
    if (geometry.indices)
        glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, geometry.indices.name());
    glBindVertexArray(0);
    return array;
}

} // namespace lodestone
