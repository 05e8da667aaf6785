#include "render/delivery.h"

#include <utility>

namespace lodestone {

void Delivery::start(DeliveryKey key, std::function<void(Load&)> pack) {
    giveUp();
    key_ = std::move(key);
    load_ = std::make_shared<Load>();
    work_.emplace([load = load_, pack = std::move(pack)] { pack(*load); });
}

void Delivery::startScene(const Renderer& renderer, const ScenePtr& scene) {
    start({scene, nullptr}, [scene, size_px = renderer.info().max_texture_size_px](Load& load) {
        load.scene = prepareScene(scene, size_px);
    });
}

void Delivery::startLod(const ScenePtr& scene, std::shared_ptr<const Lod> lod, LodPackage package) {
    auto shared = std::make_shared<LodPackage>(std::move(package));
    start({scene, std::move(lod)}, [shared](Load& load) {
        shared->pack();
        load.package = std::move(*shared);
    });
}

void Delivery::giveUp() {
    std::erase_if(dropped_, [](const BackgroundWork& work) { return work.finished(); });
    if (work_)
        dropped_.push_back(std::move(*work_));
    finish();
}

void Delivery::finish() {
    work_.reset();
    load_.reset();
    scene_.reset();
    key_.reset();
}

const LodPackage* Delivery::arrivedLod() const {
    const bool arrived = key_ && key_->lod && !work_ && load_->package.copied();
    return arrived ? &load_->package : nullptr;
}

Result<std::optional<GpuScene>> Delivery::step(const Renderer& renderer) {
    if (work_) {
        if (!work_->finished())
            return std::nullopt;
        std::string failure = work_->failure();
        work_.reset();
        if (!failure.empty()) {
            finish();
            return fail(ErrorKind::Failed, std::move(failure));
        }
    }
    if (!key_)
        return std::nullopt;
    if (key_->lod) {
        copied_bytes_ += load_->package.copy(kCopiedPerStep);
        return std::nullopt;
    }
    if (!scene_)
        scene_ = GpuScene::create(renderer, load_->scene);
    if (scene_->uploadNextTexture())
        return std::nullopt;
    std::optional<GpuScene> complete = std::exchange(scene_, std::nullopt);
    finish();
    return complete;
}

} // namespace lodestone
