#pragma once
// The scenes that are measured.
#include "scene/result.h"
#include "scene/scene.h"

#include <filesystem>
#include <map>

namespace lodestone::bench {

// Makes or reads each scene once.
class Inputs {
public:
    // models: the folder of real models, may be absent. given: folder with NAME.glb to measure as
    // well, empty: none.
    Inputs(std::filesystem::path models, std::filesystem::path given);

    // Generated: "bunny", "chair", "maple", "village", "sphere", "small sphere", "cards".
    Result<ScenePtr> own(const std::string& name);
    // GIVEN/NAME.glb; null where there is none.
    Result<ScenePtr> given(const std::string& name);
    // A real model by its path in their folder; null where there is none.
    Result<ScenePtr> model(const std::filesystem::path& path);
    // The Stanford bunny; null without the models.
    Result<ScenePtr> stanfordBunny();

private:
    // The scene of a file, read the first time; null if there is no such file.
    Result<ScenePtr> readOnce(const std::filesystem::path& path);
    std::filesystem::path models_;
    std::filesystem::path given_;
    std::map<std::string, ScenePtr> made_;
};

// A unit cube sphere with fractal bumps: 12 * side^2 triangles, closed, positions only.
ScenePtr displacedSphere(std::uint32_t side);

// A trunk under 40,000 leaves of four triangles each: 161,920 triangles, nearly all of them below
// what edge collapses may touch.
ScenePtr leafCards();

} // namespace lodestone::bench
