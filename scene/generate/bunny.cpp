// A scan-like bunny.
#include "scene/generate/sample.h"

namespace lodestone::generate {

ScenePtr makeBunny(std::uint64_t seed) {
    Mesh mesh = ball(5);
    refineTo(mesh, 69600);
    for (glm::dvec3& p : mesh.positions)
        p *= 1.0 + 0.1 * fractalNoise(p * 2.0, static_cast<std::uint32_t>(seed), 4);
    Sample sample("bunny");
    const std::uint32_t bunny = sample.add("bunny", mesh, kPi, {0xC9B79C, 0.8});
    sample.place(bunny, Trs{}, kNone);
    return sample.finish();
}

} // namespace lodestone::generate
