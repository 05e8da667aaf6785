#include "scene/generate.h"

#include "scene/generate/sample.h"

#include <array>

namespace lodestone {

namespace {

struct SampleRow {
    std::string_view name;
    ScenePtr (*make)(std::uint64_t seed);
};

constexpr std::array<SampleRow, 1> kSamples{{{"maple", generate::makeMaple}}};
constexpr std::array<std::string_view, kSamples.size()> kNames{kSamples[0].name};

} // namespace

std::span<const std::string_view> sampleNames() {
    return kNames;
}

Result<ScenePtr> generateScene(std::string_view name, std::uint64_t seed) {
    for (const SampleRow& row : kSamples)
        if (row.name == name)
            return row.make(seed);
    return fail(ErrorKind::Usage,
                "no sample scene named '" + std::string(name) + "'; choose maple");
}

} // namespace lodestone
