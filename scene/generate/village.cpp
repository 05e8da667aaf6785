// A village on gentle hills.
#include "scene/generate/sample.h"

namespace lodestone::generate {

ScenePtr makeVillage(std::uint64_t seed) {
    Sample sample("village");
    Random random(seed);
    std::vector<std::uint32_t> houses;
    for (int i = 1; i < 79; ++i) {
        Mesh mesh;
        addBox(mesh, {-3, 0, -4}, {3, 4.0 + 0.05 * i, 4});
        refineTo(mesh, 90);
        houses.push_back(sample.add("house " + std::to_string(i), mesh, 0.5, {0xE0D0B0, 0.9}));
    }
    for (std::uint32_t i = 0; i + 1 < 13523; ++i)
        sample.place(
            houses[i % 78],
            {{12.0 * (i % 116), 0.0, 12.0 * (i / 116)}, yaw(random.in(0, 6)), glm::dvec3(1)},
            kNone);
    Mesh ground;
    addBox(ground, {-10, -1, -10}, {1400, 0, 1410});
    refineTo(ground, 1254696 - sample.triangleCount());
    sample.place(sample.add("ground", ground, 0.5, {0x6C8A4A, 1.0}), Trs{}, kNone);
    return sample.finish();
}

} // namespace lodestone::generate
