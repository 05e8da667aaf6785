#include "render/gpu_geometry.h"

#include "render/renderer_state.h"
#include "scene/finite.h"

#include <algorithm>
#include <cstddef>

namespace lodestone {

namespace {

GlBuffer reserveBuffer(std::size_t size_bytes) {
    GlBuffer buffer = GlBuffer::create();
    // Not GL_ELEMENT_ARRAY_BUFFER: that would change whatever vertex array is bound.
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer.name());
    glBufferData(
        GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(size_bytes), nullptr, GL_STATIC_DRAW);
    return buffer;
}

} // namespace

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
    if (!packed.morphs.empty()) {
        gpu->morph_targets = packed.morph_targets;
        gpu->morphs = reserveBuffer(packed.morphs.size());
        gpu->morph_texture = GlTexture::create();
        glBindTexture(GL_TEXTURE_BUFFER, gpu->morph_texture.name());
        glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA32F, gpu->morphs.name());
        glBindTexture(GL_TEXTURE_BUFFER, 0);
    }
    gpu->bytes = packed.vertices.size() + packed.indices.size() + packed.morphs.size();
    return gpu;
}

std::array<glm::vec4, 3>
sceneRows(const glm::dmat4& world, const SceneFrame& scene, const LocalFrame& local) {
    const glm::dmat3 linear = glm::dmat3(world) * (local.scale / scene.radius);
    const glm::dvec3 center(world * glm::dvec4(local.center, 1.0));
    const glm::dvec3 origin = (center - scene.center) / scene.radius;
    std::array<glm::vec4, 3> rows{};
    for (int r = 0; r < 3; ++r) {
        const glm::vec4 row(linear[0][r], linear[1][r], linear[2][r], origin[r]);
        if (isFinite(row))
            rows[static_cast<std::size_t>(r)] = row;
    }
    return rows;
}

std::vector<InstanceRow> packInstances(const InstanceSource& source,
                                       const std::vector<std::uint32_t>* order) {
    const std::size_t count = order ? order->size() : source.range.size();
    std::vector<InstanceRow> rows(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t id =
            order ? (*order)[i] : source.range.begin + static_cast<std::uint32_t>(i);
        rows[i].id = id;
        std::ranges::copy(
            sceneRows(source.scene.instances[id].transform, source.scene_frame, source.local_frame),
            rows[i].rows);
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

namespace {

// Attributes 10, 11 of the first four joints, 12, 13 of the next: joints, weights.
void pointAtJoints(const VertexLayout& layout, GLuint set) {
    const GLuint index = 10 + 2 * set;
    const std::size_t offset = layout.joints_offset[set];
    glEnableVertexAttribArray(index);
    glVertexAttribIPointer(
        index,
        4,
        GL_UNSIGNED_SHORT,
        layout.stride_bytes,
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the library takes a number as a pointer
        reinterpret_cast<const void*>(offset));
    glEnableVertexAttribArray(index + 1);
    glVertexAttribPointer(
        index + 1,
        4,
        GL_FLOAT,
        GL_FALSE,
        layout.stride_bytes,
        // NOLINTNEXTLINE(performance-no-int-to-ptr): the library takes a number as a pointer
        reinterpret_cast<const void*>(offset + 4 * sizeof(std::uint16_t)));
}

} // namespace

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
    if ((layout.features & kHasTangent) != 0)
        attribute(14, 4, GL_FLOAT, layout.tangent_offset);
    if ((layout.features & kHasJoints) != 0)
        pointAtJoints(layout, 0);
    if ((layout.features & kHasMoreJoints) != 0)
        pointAtJoints(layout, 1);

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
