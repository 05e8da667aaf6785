#pragma once
// Inside render/ only: scenes and LODs on their way to the GPU, one at a time, so that no frame
// waits for them. Main thread, context current.
#include "render/background_work.h"
#include "render/lod_package.h"

#include <optional>
#include <vector>

namespace lodestone {

// What is wanted on the GPU: a scene, or where that is there, a LOD of it.
struct DeliveryKey {
    ScenePtr scene;
    std::shared_ptr<const Lod> lod; // null: the scene itself

    bool operator==(const DeliveryKey&) const = default;
};

class Delivery {
public:
    static constexpr std::uint64_t kCopiedPerStep = std::uint64_t{8} << 20u; // bytes

    bool underWay() const { return key_.has_value(); }

    const std::optional<DeliveryKey>& key() const { return key_; }

    void startScene(const Renderer& renderer, const ScenePtr& scene);
    void startLod(const ScenePtr& scene, std::shared_ptr<const Lod> lod, LodPackage package);
    void giveUp(); // whatever is under way is dropped

    // A little more: one texture, or kCopiedPerStep bytes. Errors: Failed if packing failed.
    // Returns the scene once it is complete.
    Result<std::optional<GpuScene>> step(const Renderer& renderer);

    // The LOD under way once every part of it is on the GPU, until finish(); else null.
    const LodPackage* arrivedLod() const;
    void finish();

    std::uint64_t copiedBytes() const { return copied_bytes_; } // so far, by all

private:
    struct Load { // shared with the thread that fills it
        PreparedScenePtr scene;
        LodPackage package;
    };

    void start(DeliveryKey key, std::function<void(Load&)> pack);

    std::optional<DeliveryKey> key_;
    std::shared_ptr<Load> load_;
    std::optional<BackgroundWork> work_;
    std::optional<GpuScene> scene_;       // textures still to come
    std::vector<BackgroundWork> dropped_; // given up, their threads not back yet
    std::uint64_t copied_bytes_ = 0;
};

} // namespace lodestone
