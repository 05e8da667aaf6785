#pragma once
// What a LOD needs on the GPU and does not have there yet: packed on any thread, copied in pieces.
#include "render/gpu_scene.h"

namespace lodestone {

// Move-only. Made by GpuScene::package(); reads nothing of the GpuScene afterwards.
class LodPackage {
public:
    LodPackage();
    ~LodPackage();
    LodPackage(LodPackage&&) noexcept;
    LodPackage& operator=(LodPackage&&) noexcept;

    // How much pack() has to do: triangles and instances; those without normals count kSmoothWork
    // times. 0: everything is on the GPU.
    std::uint64_t work() const;
    static constexpr std::uint64_t kSmoothWork = 8;

    // Any thread, once; no GL. May throw std::bad_alloc.
    void pack();

    // Copies at most most_bytes more to the GPU; returns how many. Main thread, after pack().
    std::uint64_t copy(std::uint64_t most_bytes);
    bool copied() const;

private:
    friend class GpuSceneState;
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace lodestone
