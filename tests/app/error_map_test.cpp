#include "app/color_map.h"
#include "app/error_map.h"
#include "scene/vertex_value.h"
#include "tests/scene/scene_fixtures.h"

#include <gtest/gtest.h>

namespace lodestone {

namespace {

const Attribute* valuesOf(const ErrorMap& map) {
    return findAttribute(map.lod->submeshes[0].primitives[0]->attributes, kVertexValueSemantic);
}

} // namespace

TEST(ErrorMap, OfTheOriginalIsZeroEverywhere) {
    const ScenePtr scene = fixtures::cubeScene();
    const auto map =
        makeErrorMap({scene, scene, std::make_shared<const Lod>(fullLod(*scene))}, JobContext());
    ASSERT_TRUE(map) << map.error().message;
    EXPECT_EQ(map->peak, 0.0);
    const Attribute* const values = valuesOf(*map);
    ASSERT_TRUE(values);
    for (std::size_t vertex = 0; vertex < 24; ++vertex)
        EXPECT_EQ(attributeValue(*values, vertex, 0), 0.0f);
}

TEST(ErrorMap, IsTheDistanceOfAMovedVertexInPercentOfTheDiagonal) {
    const ScenePtr scene = fixtures::cubeScene();
    auto lod = std::make_shared<Lod>(fullLod(*scene));
    auto moved = std::make_shared<Geometry>(*lod->submeshes[0].primitives[0]);
    const std::uint32_t corner = moved->indices[0];
    const glm::vec3 outwards = glm::normalize(moved->positions[corner]);
    moved->positions[corner] += outwards * 0.1f;
    moved->indices.resize(30); // no longer the original
    lod->submeshes[0].primitives[0] = moved;
    lod->triangles = 10;
    const auto map = makeErrorMap({scene, scene, lod}, JobContext());
    ASSERT_TRUE(map) << map.error().message;
    const Attribute* const values = valuesOf(*map);
    ASSERT_TRUE(values);
    const double diagonal = robustWorldBounds(*scene).diagonal();
    EXPECT_NEAR(static_cast<double>(attributeValue(*values, corner, 0)), 10.0 / diagonal, 1e-3);
    EXPECT_NEAR(map->peak, 10.0 / diagonal, 1e-3);
    EXPECT_EQ(lod->submeshes[0].primitives[0]->attributes.size() + 1,
              map->lod->submeshes[0].primitives[0]->attributes.size())
        << "the LOD itself stays as it is";
}

TEST(ColorMap, RisesFromDarkToLightAndClamps) {
    for (const ColorMap map : {ColorMap::Viridis, ColorMap::Cividis}) {
        int last = -1;
        for (int step = 0; step <= 32; ++step) {
            const MapColor color = mapColorAt(map, step / 32.0);
            const int light = 2 * color[0] + 7 * color[1] + color[2];
            EXPECT_GT(light, last) << step;
            last = light;
        }
        EXPECT_EQ(mapColorAt(map, -3.0), mapColors(map).front());
        EXPECT_EQ(mapColorAt(map, 7.0), mapColors(map).back());
    }
}

} // namespace lodestone
