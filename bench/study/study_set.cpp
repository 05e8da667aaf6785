#include "bench/study/study_set.h"

#include "bench/study/made_scene.h"
#include "scene/generate.h"
#include "scene/generate/numbers.h"
#include "scene/import.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

namespace lodestone::bench {

namespace fs = std::filesystem;

namespace {

// Instances per submesh below which that share of the made scenes lies; between: by the logarithm.
struct IpsMark {
    double share = 0.0;
    double ips = 1.0;
};

constexpr std::array kIpsMarks{IpsMark{0.0, 1.0},
                               IpsMark{0.10, 1.75},
                               IpsMark{0.45, 5.0},
                               IpsMark{0.70, 20.0},
                               IpsMark{0.88, 100.0},
                               IpsMark{1.0, 1000.0}};

double between(double low, double high, double share) {
    return low * std::pow(high / low, share);
}

double ipsAt(double share) {
    std::size_t mark = 1;
    while (mark + 1 < kIpsMarks.size() && kIpsMarks[mark].share < share)
        ++mark;
    const IpsMark& low = kIpsMarks[mark - 1];
    const IpsMark& high = kIpsMarks[mark];
    return between(low.ips, high.ips, (share - low.share) / (high.share - low.share));
}

// Most are small; one in forty has some hundred thousand triangles, up to 1.8 million.
SceneRecipe recipeOf(std::uint32_t number, std::uint32_t count) {
    generate::Random random(7919 + number);
    const double ips = ipsAt((number + 0.5) / count);
    SceneRecipe recipe;
    recipe.seed = number + 1;
    recipe.kind = kSceneKinds[number % kSceneKinds.size()];
    const double submeshes = between(1.0, 30.0, random.unit());
    recipe.submeshes =
        static_cast<std::uint32_t>(std::lround(std::min(submeshes, 1.0 + 4000.0 / ips)));
    recipe.instances =
        std::max(recipe.submeshes, static_cast<std::uint32_t>(std::lround(ips * recipe.submeshes)));
    const bool large = random.below(40) == 0;
    const double triangles = large ? between(2e5, 1.8e6, random.unit())
                                   : between(60.0, 1e5, std::pow(random.unit(), 1.2));
    recipe.part_faces =
        static_cast<std::uint32_t>(std::clamp(triangles / recipe.instances, 4.0, 60'000.0));
    return recipe;
}

bool isModel(const fs::path& path) {
    constexpr std::array kExtensions{
        ".gltf", ".glb", ".dae", ".3ds", ".obj", ".ply", ".stl", ".fbx"};
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) {
        return static_cast<char>(std::tolower(c));
    });
    return std::ranges::find(kExtensions, extension) != kExtensions.end();
}

std::vector<fs::path> realModels(const fs::path& folder) {
    std::vector<fs::path> paths;
    std::error_code error;
    for (const auto& entry : fs::recursive_directory_iterator(folder, error)) {
        const fs::path inside = entry.path().lexically_relative(folder);
        if (*inside.begin() != "bad" && isModel(inside))
            paths.push_back(inside);
    }
    std::ranges::sort(paths);
    return paths;
}

} // namespace

std::vector<StudyModel> studySet(const fs::path& models, std::uint32_t made) {
    std::vector<StudyModel> set;
    for (const std::string_view name : sampleNames())
        set.push_back({std::string(name), "sample", [name] { return generateScene(name); }});
    for (const fs::path& inside : realModels(models))
        set.push_back({inside.generic_string(), "real", [path = models / inside] {
                           return importScene(path, {});
                       }});
    for (std::uint32_t number = 0; number < made; ++number) {
        const SceneRecipe recipe = recipeOf(number, made);
        set.push_back({std::string(kindName(recipe.kind)) + " " + std::to_string(recipe.seed),
                       kindName(recipe.kind),
                       [recipe]() -> Result<ScenePtr> { return makeScene(recipe); }});
    }
    return set;
}

} // namespace lodestone::bench
