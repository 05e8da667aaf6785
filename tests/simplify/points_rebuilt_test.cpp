// The surface rebuilt from points alone: what the option "retriangulation=points" promises.
#include "scene/generate.h"
#include "simplify/algorithm.h"
#include "simplify/pointcloud/advancing_front.h"
#include "tests/simplify/meshes.h"

#include <cmath>
#include <gtest/gtest.h>

namespace lodestone {

namespace {

class PointsRebuilt : public ::testing::Test {
protected:
    void SetUp() override {
        if (!canRebuildFromPoints())
            GTEST_SKIP() << "built without CGAL";
    }
};

// Of one submesh, after spherical scanning; radius_percent: of the diagonal.
std::vector<GeometryPtr> rebuilt(const GeometryPtr& geometry, double radius_percent) {
    const ScenePtr scene = meshes::sceneOf({meshes::submeshOf({geometry})}, {{glm::dmat4(1.0)}});
    const ParameterValues values{{"radius", radius_percent}, {"retriangulation", 1.0}};
    const LodSourcePtr source = findAlgorithm("ss")->prepare(scene, values, {}, {}).value();
    return source->readOut(1, nullptr).submeshes[0].primitives;
}

glm::dvec3 corner(const Geometry& geometry, std::size_t index) {
    return geometry.positions[geometry.indices[index]];
}

// Enclosed; negative where a closed surface faces inwards.
double volumeOf(std::span<const GeometryPtr> primitives) {
    double volume = 0.0;
    for (const GeometryPtr& geometry : primitives)
        for (std::size_t i = 0; i < geometry->indices.size(); i += 3)
            volume += glm::dot(corner(*geometry, i),
                               glm::cross(corner(*geometry, i + 1), corner(*geometry, i + 2))) /
                      6.0;
    return volume;
}

void expectClosedAndAlike(const GeometryPtr& geometry, double radius_percent) {
    const std::vector<GeometryPtr> primitives = rebuilt(geometry, radius_percent);
    const meshes::Shape shape = meshes::shapeOf(primitives);
    EXPECT_LT(shape.faces, geometry->triangleCount() / 2);
    EXPECT_EQ(shape.border_edges, 0u);
    EXPECT_EQ(shape.non_manifold_edges, 0u);
    EXPECT_EQ(shape.degenerate_faces, 0u);
    const double volume = volumeOf(std::vector{geometry});
    EXPECT_NEAR(volumeOf(primitives), volume, 0.1 * std::abs(volume));
}

} // namespace

TEST_F(PointsRebuilt, SpheresFaceOutwardsAllOver) {
    for (const GeometryPtr& geometry : rebuilt(meshes::sphere(24, 32, 0.0), 6.0))
        for (std::size_t i = 0; i < geometry->indices.size(); i += 3) {
            const glm::dvec3 a = corner(*geometry, i);
            const glm::dvec3 normal =
                glm::cross(corner(*geometry, i + 1) - a, corner(*geometry, i + 2) - a);
            EXPECT_GT(glm::dot(normal, a), 0.0);
        }
}

TEST_F(PointsRebuilt, ClosedSurfacesStayClosedAndFaceAsBefore) {
    expectClosedAndAlike(meshes::sphere(24, 32, 0.0), 6.0);
    expectClosedAndAlike(meshes::torus(40, 20), 5.0);
    auto turned = std::make_shared<Geometry>(*meshes::sphere(24, 32, 0.0));
    for (std::size_t i = 0; i < turned->indices.size(); i += 3)
        std::swap(turned->indices[i + 1], turned->indices[i + 2]);
    expectClosedAndAlike(turned, 6.0);
}

TEST_F(PointsRebuilt, ABunnyOfUnitSizeHasNoHoles) {
    const ScenePtr scene = generateScene("bunny").value();
    auto unit = std::make_shared<Geometry>(*scene->submeshes[0].primitives[0].geometry);
    const double size = localBounds(scene->submeshes[0]).diagonal();
    for (glm::vec3& position : unit->positions)
        position = glm::vec3(glm::dvec3(position) / size);
    for (const double radius_percent : {1.0, 2.0, 3.0})
        expectClosedAndAlike(unit, radius_percent);
}

} // namespace lodestone
