// Which scenes we are measured on beside peers.
#include "bench/figures.h"

#include <array>

namespace lodestone::bench {

namespace {

enum class From : std::uint8_t { Generator, Model };

struct PeerInputFile {
    const char* title;
    From from;
    const char* name; // of the generator, or path in the folder of models
    bool quick;       // also in a quick run
};

// Single meshes, then instanced scenes, then textured ones.
constexpr std::array kInputs{
    PeerInputFile{"Stanford bunny", From::Model, "meshes/bun_zipper/bun_zipper.ply", true},
    PeerInputFile{"Small displaced sphere", From::Generator, "small sphere", false},
    PeerInputFile{"Horse", From::Model, "meshes/horse/horse.ply", false},
    PeerInputFile{"Fandisk", From::Model, "meshes/fandisk/fandisk.obj", true},
    PeerInputFile{"Chair", From::Generator, "chair", true},
    PeerInputFile{"Maple", From::Generator, "maple", true},
    PeerInputFile{"Village", From::Generator, "village", true},
    PeerInputFile{
        "Engine", From::Model, "instanced/2CylinderEngine-glb/2CylinderEngine.glb", false},
    PeerInputFile{"Fire alarms",
                  From::Model,
                  "instanced/WestRiverSideHospital-fireAlarms/fireAlarms.gltf",
                  false},
    PeerInputFile{"Duplex", From::Model, "instanced/duplex/scene.gltf", false},
    PeerInputFile{"Castle", From::Model, "instanced/castle/castle.gltf", false},
    PeerInputFile{"Duck", From::Model, "textured/Duck/Duck.glb", false},
    PeerInputFile{"Damaged helmet", From::Model, "textured/DamagedHelmet/DamagedHelmet.glb", true},
};

Result<ScenePtr> sceneOf(const PeerInputFile& input, Inputs& inputs) {
    return input.from == From::Model ? inputs.model(input.name) : inputs.own(input.name);
}

// Null where the input is absent.
Result<std::optional<PeerSheet>>
sheetOf(const PeerInputFile& input, const PeerBench& bench, Inputs& inputs) {
    const Result<ScenePtr> scene = sceneOf(input, inputs);
    if (!scene)
        return tl::unexpected(scene.error());
    if (!*scene)
        return std::nullopt;
    Result<PeerSheet> sheet = measurePeers(bench, input.title, *scene);
    if (!sheet)
        return tl::unexpected(sheet.error());
    return std::move(*sheet);
}

} // namespace

std::vector<PeerSection> peerSections() {
    std::vector<PeerSection> sections;
    sections.reserve(kInputs.size());
    for (const PeerInputFile& input : kInputs)
        sections.push_back(
            {input.title, input.quick, [&input](const PeerBench& bench, Inputs& inputs) {
                 return sheetOf(input, bench, inputs);
             }});
    return sections;
}

} // namespace lodestone::bench
