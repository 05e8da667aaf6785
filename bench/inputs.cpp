#include "bench/inputs.h"

#include "scene/generate.h"
#include "scene/import.h"

namespace lodestone::bench {

Inputs::Inputs(std::filesystem::path models, std::filesystem::path given)
    : models_(std::move(models)), given_(std::move(given)) {}

Result<ScenePtr> Inputs::own(const std::string& name) {
    ScenePtr& scene = made_[name];
    if (scene)
        return scene;
    if (name == "sphere")
        return scene = displacedSphere(289);
    if (name == "small sphere")
        return scene = displacedSphere(64);
    if (name == "cards")
        return scene = leafCards();
    Result<ScenePtr> generated = generateScene(name);
    if (generated)
        scene = *generated;
    return generated;
}

Result<ScenePtr> Inputs::given(const std::string& name) {
    const std::filesystem::path path = given_ / (name + ".glb");
    return given_.empty() ? ScenePtr() : readOnce(path);
}

Result<ScenePtr> Inputs::model(const std::filesystem::path& path) {
    return readOnce(models_ / path);
}

Result<ScenePtr> Inputs::stanfordBunny() {
    return model("meshes/bun_zipper/bun_zipper.ply");
}

Result<ScenePtr> Inputs::readOnce(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path))
        return ScenePtr();
    ScenePtr& scene = made_[path.string()];
    if (scene)
        return scene;
    Result<ScenePtr> read = importScene(path, {});
    if (read)
        scene = *read;
    return read;
}

} // namespace lodestone::bench
