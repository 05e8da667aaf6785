#pragma once
// Inside render/ only: what GpuScene and LodHandle own.
#include "render/gpu_pose.h"
#include "render/gpu_scene.h"
#include "render/lod_package_parts.h"
#include "render/prepared_scene_parts.h"
#include "render/renderer_state.h"

#include <array>
#include <map>
#include <unordered_map>

namespace lodestone {

// Layout of the uniform block Material in shaders/common.glsl (std140).
struct MaterialBlock {
    glm::vec4 base_color{1.0f};
    glm::vec4 emissive{0.0f}; // w: alpha cut-off
    glm::vec4 factors{0.0f};  // metallic, roughness, normal scale, occlusion strength
    std::array<glm::vec4, kMaterialMaps> uv_u{};
    std::array<glm::vec4, kMaterialMaps> uv_v{};
};

struct MaterialMap {
    GLuint texture = 0;
    GLuint sampler = 0;
};

struct GpuMaterial {
    std::uint32_t features = 0; // maps, alpha, unlit
    bool double_sided = false;
    std::array<MaterialMap, kMaterialMaps> maps;
    GLintptr block_offset = 0; // in GpuSceneState::material_blocks
};

// Something drawn with one call.
struct DrawItem {
    std::shared_ptr<const GpuGeometry> geometry;
    std::shared_ptr<const InstanceBuffer> instances;
    GlVertexArray vertex_array;
    std::uint32_t submesh = 0;
    std::uint32_t material = 0; // in GpuSceneState::materials
    PrimitiveMode mode = PrimitiveMode::Triangles;
    std::uint32_t kept_instances = 0;
};

struct LodState {
    std::vector<DrawItem> items; // opaque ones first
    std::uint64_t revision = 0;
    std::uint64_t triangles = 0;
};

class GpuSceneState {
public:
    GpuSceneState(std::shared_ptr<RendererState> shared, PreparedScenePtr source);
    void open();
    bool uploadNextTexture(); // false: all are there

    Result<LodPackage> package(const Lod& lod);
    void offer(const LodPackage& package);
    Result<UploadReport> update(std::unique_ptr<LodState>& handle, const Lod& lod);
    std::uint64_t memoryBytes() const;
    void setMoment(const Moment& moment);

    // Of an instance in the pose that is drawn; one with a skin has none.
    const glm::dmat4& transform(std::uint32_t instance) const {
        return pose.transforms.empty() ? scene->instances[instance].transform
                                       : pose.transforms[instance];
    }

    bool isPosed(std::uint32_t submesh) const {
        return pose.submeshes[submesh].posed || pose.submeshes[submesh].morphed;
    }

    // Positions as a posed instance shows them, in the world.
    std::vector<glm::dvec3> posedPositions(const Geometry& geometry, std::uint32_t instance) const;
    Mirroring mirroring(std::uint32_t submesh) const;

    std::shared_ptr<RendererState> renderer;
    ScenePtr scene;
    Bounds bounds;
    SceneFrame frame;
    std::vector<GpuSubmesh> submeshes;  // [scene.submeshes]
    std::vector<GpuMaterial> materials; // [scene.materials + 1]; the last is glTF's default
    GlBuffer material_blocks;
    std::vector<std::string> notes;
    std::vector<bool> hidden; // [submeshes] or empty
    std::uint64_t revision = 0;
    PackedPose pose; // that is drawn
    GlTexture pose_texture;

private:
    void uploadPose();
    void openTextures();
    void openMaterials();
    Result<void> check(const Lod& lod) const;
    LodPackage missingParts(const Lod& lod);
    std::uint32_t keptInstances(const LodSubmesh& submesh, std::uint32_t index) const;
    std::unique_ptr<LodState> assemble(const Lod& lod, LodState* last, bool& changed);
    void forgetExpired();

    RigPtr rig_;
    Pose rest_;
    Moment moment_;
    GlBuffer pose_buffer_; // of pose_texture
    std::vector<GpuTexture> textures_;
    std::uint64_t texture_bytes_ = 0;
    template <class Key, class Value>
    using Cache = std::map<std::pair<const Key*, std::uint32_t>, std::weak_ptr<const Value>>;
    Cache<Geometry, GpuGeometry> geometries_;
    Cache<std::vector<std::uint32_t>, InstanceBuffer> instances_;
    PreparedScenePtr prepared_; // until every texture is uploaded
    std::size_t next_texture_ = 0;
};

} // namespace lodestone
