#pragma once
// A scene on the GPU: textures and materials once, geometry shared among its LODs by GeometryPtr
// identity, transforms in one buffer for each submesh. Main thread, context current.
#include "render/frame_points.h"
#include "render/prepared_scene.h"
#include "render/renderer.h"
#include "scene/lod.h"
#include "scene/pose.h"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace lodestone {

class GpuSceneState; // render/gpu_scene_state.h, inside this folder
class LodPackage;    // render/lod_package.h
struct LodState;

struct UploadReport {
    std::uint32_t geometries = 0; // uploaded by this call; the rest was there
    std::uint32_t instance_buffers = 0;
    std::uint64_t bytes = 0;
};

// A LOD on the GPU. Move-only; what no handle uses any more is freed. May outlive its GpuScene.
class LodHandle {
public:
    LodHandle();
    ~LodHandle();
    LodHandle(LodHandle&&) noexcept;
    LodHandle& operator=(LodHandle&&) noexcept;

    bool valid() const { return state_ != nullptr; }

    // Changes with every update that changed anything drawn; unique among all LODs.
    std::uint64_t revision() const;
    std::uint64_t triangles() const; // instanced

    const LodState* state() const { return state_.get(); }

private:
    friend class GpuScene;
    std::unique_ptr<LodState> state_;
};

class GpuScene {
public:
    // Decodes and uploads textures. What cannot be decoded is drawn neutral and named in notes().
    // Never fails for odd scenes (nothing to draw, far outliers).
    static Result<GpuScene> create(const Renderer& renderer, ScenePtr scene);
    // The same in steps that no frame waits for long: everything but textures at once, then one
    // texture a call until uploadNextTexture() returns false. Draw only after that.
    static GpuScene create(const Renderer& renderer, const PreparedScenePtr& prepared);
    bool uploadNextTexture();
    GpuScene(GpuScene&&) noexcept;
    GpuScene& operator=(GpuScene&&) noexcept;
    ~GpuScene();

    const ScenePtr& scene() const;
    const Bounds& bounds() const;    // robust
    FramePoints framePoints() const; // for frameCamera; computed by each call
    const std::vector<std::string>& notes() const;
    std::uint64_t memoryBytes() const; // geometry + instances + textures now on the GPU

    // lod: of this scene (same number of submeshes and primitives).
    // Cost: what changed since the last LOD of this handle, nothing for shared pointers.
    // Errors: Usage if the LOD does not fit the scene.
    Result<UploadReport> update(LodHandle& handle, const Lod& lod);
    // What update() would have to pack and copy. Errors as update().
    Result<LodPackage> package(const Lod& lod) const;
    // A copied package's parts are found by update() as long as the package lives.
    void offer(const LodPackage& package);

    // Hidden submeshes are not drawn in any LOD. Empty: all shown.
    void setHiddenSubmeshes(std::vector<bool> hidden); // [submeshes] or empty
    // What all LODs are drawn as, at rest at first. Costs nothing if it is the last one, else a
    // few bytes for each joint and moving instance go to the GPU.
    void setMoment(const Moment& moment);
    std::uint64_t revision() const; // changes with what the two calls above change

    const GpuSceneState& state() const { return *state_; }

private:
    explicit GpuScene(std::shared_ptr<GpuSceneState> state);
    std::shared_ptr<GpuSceneState> state_;
};

} // namespace lodestone
