#include "scene/generate.h"

#include "scene/generate/sample.h"

#include <array>

namespace lodestone {

namespace {

struct SampleRow {
    std::string_view name;
    ScenePtr (*make)(std::uint64_t seed);
};

constexpr std::array<SampleRow, 4> kSamples{{{"bunny", generate::makeBunny},
                                             {"chair", generate::makeChair},
                                             {"maple", generate::makeMaple},
                                             {"village", generate::makeVillage}}};
constexpr std::array<std::string_view, kSamples.size()> kNames{
    kSamples[0].name, kSamples[1].name, kSamples[2].name, kSamples[3].name};

} // namespace

std::span<const std::string_view> sampleNames() {
    return kNames;
}

Result<ScenePtr> generateScene(std::string_view name, std::uint64_t seed) {
    for (const SampleRow& row : kSamples)
        if (row.name == name)
            return row.make(seed);
    return fail(ErrorKind::Usage,
                "no sample scene named '" + std::string(name) +
                    "'; choose bunny, chair, maple or village");
}

} // namespace lodestone
