// Other people's simplifiers, as the bench drives them.
#include "bench/inputs.h"
#include "bench/peers/nearest.h"
#include "bench/peers/peer.h"
#include "bench/peers/reduce_scene.h"

#include <gtest/gtest.h>

namespace lodestone::bench {

namespace {

// Two triangles that share an edge in space but not in vertices, and one without area.
Geometry seamedQuad() {
    Geometry geometry;
    geometry.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    geometry.indices = {0, 1, 2, 3, 4, 5, 1, 3, 2};
    return geometry;
}

class EveryPeer : public testing::TestWithParam<MeshPeer> {};

std::string testName(const testing::TestParamInfo<MeshPeer>& info) {
    std::string name;
    for (const char letter : info.param.name)
        if (std::isalnum(static_cast<unsigned char>(letter)) != 0)
            name += letter;
    return name;
}

TEST_P(EveryPeer, BringsAClosedSphereNearItsTargetWithFinitePositionsAndValidIndices) {
    const ScenePtr scene = displacedSphere(12);
    const PeerInput input(*scene, GetParam().welding, 0.5);
    const Result<ReducedScene> reduced = input.reduce(GetParam());
    ASSERT_TRUE(reduced) << reduced.error().message;
    const std::uint64_t full = countScene(*scene).triangles;
    EXPECT_LE(reduced->lod.triangles, full * 55 / 100);
    EXPECT_GE(reduced->lod.triangles, full / 10);
    EXPECT_GE(reduced->seconds, 0.0);
    const Geometry& made = *reduced->lod.submeshes[0].primitives[0];
    EXPECT_EQ(faultOf({made.positions, made.indices}), "");
    for (const glm::vec3& position : made.positions)
        EXPECT_LT(glm::length(position), 2.0F);
}

INSTANTIATE_TEST_SUITE_P(Linked, EveryPeer, testing::ValuesIn(meshPeers("").present), testName);

} // namespace

TEST(WeldedMesh, JoinsEqualPositionsAndDropsTrianglesThatLoseACorner) {
    const PeerMesh welded = weldedMesh(seamedQuad());
    EXPECT_EQ(welded.positions.size(), 4U);
    EXPECT_EQ(welded.triangleCount(), 2U);
    EXPECT_EQ(faultOf(welded), "");
}

TEST(PeerFault, NamesIndicesOutOfRangeAndPositionsThatAreNotFinite) {
    const PeerMesh out_of_range{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 3}};
    EXPECT_EQ(faultOf(out_of_range), "an index is out of range");
    const PeerMesh not_finite{{{0, 0, 0}, {1, 0, 0}, {0, NAN, 0}}, {0, 1, 2}};
    EXPECT_EQ(faultOf(not_finite), "a position is not finite");
}

TEST(PeerInput, ANewVertexGetsTheAttributesOfTheNearestStoredOne) {
    Scene scene = *displacedSphere(4);
    auto geometry = std::make_shared<Geometry>(*scene.submeshes[0].primitives[0].geometry);
    Attribute number{"_NUMBER", ComponentType::Float32, 1, false, {}};
    number.bytes.resize(geometry->positions.size() * sizeof(float));
    for (std::size_t vertex = 0; vertex < geometry->positions.size(); ++vertex)
        setAttributeValue(number, vertex, 0, static_cast<float>(vertex));
    geometry->attributes.push_back(number);
    scene.submeshes[0].primitives[0].geometry = geometry;
    const MeshPeer one_triangle{
        "one triangle", Welding::Positions, [&](std::span<const Job>) -> Result<Reduced> {
            const std::vector<glm::vec3>& p = geometry->positions;
            const glm::vec3 beside = p[7] + 1e-3F * (p[8] - p[7]);
            return Reduced{{{{p[3], p[5], beside}, {0, 1, 2}}}, 0.0};
        }};
    const Result<ReducedScene> reduced =
        PeerInput(scene, Welding::Positions, 0.5).reduce(one_triangle);
    ASSERT_TRUE(reduced) << reduced.error().message;
    const Geometry& made = *reduced->lod.submeshes[0].primitives[0];
    const Attribute* kept = findAttribute(made.attributes, "_NUMBER");
    ASSERT_NE(kept, nullptr);
    EXPECT_EQ(attributeValue(*kept, 0, 0), 3.0F);
    EXPECT_EQ(attributeValue(*kept, 1, 0), 5.0F);
    EXPECT_EQ(attributeValue(*kept, 2, 0), 7.0F);
}

TEST(PeerInput, AnIndexOutOfRangeFailsNamingThePeer) {
    const ScenePtr scene = displacedSphere(4);
    const MeshPeer broken{
        "broken", Welding::Positions, [](std::span<const Job>) -> Result<Reduced> {
            return Reduced{{{{{0, 0, 0}}, {0, 0, 1}}}, 0.0};
        }};
    const Result<ReducedScene> reduced = PeerInput(*scene, Welding::Positions, 0.5).reduce(broken);
    ASSERT_FALSE(reduced);
    EXPECT_EQ(reduced.error().message, "broken: an index is out of range");
}

TEST(NearestPoint, FindsWhatALoopOverAllPointsFinds) {
    const ScenePtr scene = displacedSphere(8);
    const std::vector<glm::vec3>& points = scene->submeshes[0].primitives[0].geometry->positions;
    const NearestPoint nearest(points);
    for (std::size_t i = 0; i < points.size(); i += 5) {
        const glm::vec3 asked = 0.9F * points[i] + glm::vec3(0.03F, -0.02F, 0.01F);
        float best = std::numeric_limits<float>::infinity();
        for (const glm::vec3& point : points)
            best = std::min(best, glm::distance(point, asked));
        EXPECT_EQ(glm::distance(points[nearest(asked)], asked), best);
    }
}

} // namespace lodestone::bench
