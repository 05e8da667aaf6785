#pragma once
// The models of the study: real ones and made ones.
#include "scene/result.h"
#include "scene/scene.h"

#include <filesystem>
#include <functional>

namespace lodestone::bench {

struct StudyModel {
    std::string name;
    std::string kind; // "real", "sample", or of a made scene
    std::function<Result<ScenePtr>()> make;
};

// models: folder of real ones, may be absent. made: how many made ones, spread over all kinds,
// sizes and instances per submesh (IPS): with as many as a tenth below 1.75, half below 5, a tenth
// of 100 to 1000. The four samples come first. The same list for the same folder.
std::vector<StudyModel> studySet(const std::filesystem::path& models, std::uint32_t made);

} // namespace lodestone::bench
