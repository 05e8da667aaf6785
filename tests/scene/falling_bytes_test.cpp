// Sizes along the positions of real schedules: what a byte target relies on.
#include "scene/export.h"
#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "tests/scene/scene_fixtures.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace lodestone {
namespace {

bool sameCounts(const LodShape& a, const LodShape& b) {
    return std::ranges::equal(a.submeshes, b.submeshes, [](const auto& x, const auto& y) {
        return x.kept_instances == y.kept_instances &&
               std::ranges::equal(x.primitives,
                                  y.primitives,
                                  [](const PrimitiveShape& p, const PrimitiveShape& q) {
                                      return p.vertices == q.vertices && p.indices == q.indices;
                                  });
    });
}

// 200 positions over the whole range, and runs of consecutive ones.
std::vector<std::uint64_t> positionsToCheck(std::uint64_t count) {
    std::vector<std::uint64_t> positions;
    for (std::uint64_t i = 0; i < 200; ++i)
        positions.push_back((count - 1) * i / 199);
    for (const double start : {0.0, 0.3, 0.7, 0.95})
        for (std::uint64_t i = 0; i < 40; ++i)
            positions.push_back(static_cast<std::uint64_t>(static_cast<double>(count) * start) + i);
    for (std::uint64_t i = 1; i <= std::min<std::uint64_t>(count, 60); ++i)
        positions.push_back(count - i);
    std::erase_if(positions, [&](std::uint64_t position) { return position >= count; });
    std::ranges::sort(positions);
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    return positions;
}

void expectFalling(const LodSource& source, Instancing instancing) {
    const ByteModel model(source.scene(), {instancing});
    LodShape before = source.shapeAt(0);
    std::uint64_t bytes_before = model.bytes(before);
    for (const std::uint64_t position : positionsToCheck(source.positionCount())) {
        LodShape shape = source.shapeAt(position);
        if (sameCounts(before, shape))
            continue;
        const std::uint64_t bytes = model.bytes(shape);
        ASSERT_LT(bytes, bytes_before) << source.scene()->name << ", instancing "
                                       << static_cast<int>(instancing) << ", position " << position;
        bytes_before = bytes;
        before = std::move(shape);
    }
}

void expectFalling(const ScenePtr& scene, const char* algorithm) {
    const auto source = findAlgorithm(algorithm)->prepare(scene, {}, {}, {});
    ASSERT_TRUE(source) << source.error().message;
    for (const Instancing instancing :
         {Instancing::Auto, Instancing::Nodes, Instancing::Gpu, Instancing::Expand})
        expectFalling(**source, instancing);
}

class FallingBytes : public ::testing::TestWithParam<const char*> {};

TEST_P(FallingBytes, OfSamplesUnderIas) {
    expectFalling(*generateScene(GetParam()), "ias");
}

INSTANTIATE_TEST_SUITE_P(Samples,
                         FallingBytes,
                         ::testing::Values("chair", "maple", "village", "bunny"),
                         [](const auto& sample) { return std::string(sample.param); });

TEST(FallingBytesOf, TheExpandedChairUnderQuadric) {
    expectFalling(*generateScene("chair"), "quadric");
}

TEST(FallingBytesOf, FixturesUnderEitherAlgorithm) {
    for (const ScenePtr& scene : {fixtures::twoMaterialCubeScene(),
                                  fixtures::awkwardInstancesScene(),
                                  fixtures::texturedQuadScene(),
                                  fixtures::cubeRowScene(40),
                                  fixtures::gridScene(20)})
        for (const char* algorithm : {"ias", "quadric"})
            expectFalling(scene, algorithm);
}

} // namespace
} // namespace lodestone
