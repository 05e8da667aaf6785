#pragma once
// Inside render/ only: vertices and indices of one primitive, and transforms of one submesh.
#include "render/gl_object.h"
#include "scene/scene.h"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace lodestone {

// Vertices are uploaded as (position - center) / scale, so that floats keep their precision far
// from the origin; transforms undo it. The same for all LODs of a submesh.
struct LocalFrame {
    glm::dvec3 center{0.0};
    double scale = 1.0; // > 0
};

// From the bulk of the vertices: a far outlier does not coarsen the rest. O(1) samples.
LocalFrame localFrame(const Submesh& submesh);

struct VertexLayout {
    GLsizei stride_bytes = 0;
    std::uint32_t features = 0; // kHas..., kMorphed
    std::size_t normal_offset = 0;
    std::size_t uv0_offset = 0;
    std::size_t uv1_offset = 0;
    std::size_t color_offset = 0;
    std::size_t value_offset = 0;
    std::size_t tangent_offset = 0;
    std::size_t joints_offset[2] = {0, 0}; // four uint16, then four floats
};

struct GpuGeometry {
    GeometryPtr source;            // keeps the identity it is cached by
    glm::dvec3 source_center{0.0}; // middle of its box
    double source_radius = 0.0;    // of the ball about it, local units
    GlBuffer vertices;
    GlBuffer indices;
    VertexLayout layout;
    GLenum index_type = GL_UNSIGNED_INT;
    std::uint32_t index_count = 0; // 0: drawn without indices
    std::uint32_t vertex_count = 0;
    // Texels of four floats, a delta of position and one of the normal for each vertex of each
    // morph target.
    GlBuffer morphs;
    GlTexture morph_texture; // of `morphs`
    std::uint32_t morph_targets = 0;
    std::uint64_t bytes = 0;
};

// Triangles without usable normals are smoothed when they are packed (see smooth_normals.h).
bool lacksNormals(const Geometry& geometry, PrimitiveMode mode);

// A primitive as the GPU takes it.
struct PackedGeometry {
    GeometryPtr source;
    glm::dvec3 source_center{0.0};
    double source_radius = 0.0;
    VertexLayout layout;
    GLenum index_type = GL_UNSIGNED_INT;
    std::uint32_t index_count = 0;
    std::uint32_t vertex_count = 0;
    std::vector<std::byte> vertices;
    std::vector<std::byte> indices;
    std::vector<std::byte> morphs;
    std::uint32_t morph_targets = 0;
};

// Any thread; no GL. Cost: 25 ns a vertex, with normals to smooth 400 ns a triangle.
PackedGeometry packGeometry(const GeometryPtr& source, const LocalFrame& frame, PrimitiveMode mode);

// Buffers of the right size, their contents still to come.
std::shared_ptr<GpuGeometry> reserveGeometry(const PackedGeometry& packed);

// World to scene units: (p - center) / radius.
struct SceneFrame {
    glm::dvec3 center{0.0};
    double radius = 1.0; // > 0
};

// One row for each instance: three rows of the 3x4 matrix, then the index in Scene::instances.
struct InstanceRow {
    glm::vec4 rows[3];
    std::uint32_t id = 0;
};

// Scene from local (packed) coordinates; all zero where it is not finite.
std::array<glm::vec4, 3>
sceneRows(const glm::dmat4& world, const SceneFrame& scene, const LocalFrame& local);

struct InstanceBuffer {
    std::shared_ptr<const std::vector<std::uint32_t>> order; // null: the scene's order
    GlBuffer rows;
    std::uint32_t count = 0;
    std::uint64_t bytes = 0;
};

struct InstanceSource {
    const Scene& scene;
    InstanceRange range;
    SceneFrame scene_frame;
    LocalFrame local_frame;
};

// Any thread; no GL. Indices of order that are out of range are an error of the caller (checked by
// GpuScene).
std::vector<InstanceRow> packInstances(const InstanceSource& source,
                                       const std::vector<std::uint32_t>* order);

std::shared_ptr<InstanceBuffer>
reserveInstances(std::shared_ptr<const std::vector<std::uint32_t>> order, std::uint32_t count);

// Copies bytes begin.. into a buffer, at most `most` of them; returns how many.
std::size_t copyToBuffer(const GlBuffer& buffer,
                         std::span<const std::byte> bytes,
                         std::size_t begin,
                         std::size_t most);

// Attributes 5..8 of the bound vertex array: instance 0 is the one at `first`. OpenGL 3.3 has no
// base instance.
void pointAtInstances(const InstanceBuffer& instances, std::uint32_t first);

// Attributes 0..4 and 9..14 from the geometry, 5..8 from the instances, indices bound.
GlVertexArray makeVertexArray(const GpuGeometry& geometry, const InstanceBuffer& instances);

} // namespace lodestone
