#include "simplify/algorithm.h"
#include "simplify/pointcloud/circles.h"
#include "simplify/pointcloud/cloud_submesh.h"
#include "simplify/pointcloud/polygon.h"
#include "simplify/pointcloud/retriangulate.h"
#include "simplify/pointcloud/vertex_grid.h"
#include "tests/simplify/meshes.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace lodestone {

namespace {

constexpr std::array<std::string_view, 6> kIds{"vt", "fad", "ivdd", "ss", "vtd", "fass"};

const std::vector<const CloudMethod*>& methods() {
    static const std::vector<const CloudMethod*> kMethods{&kVertexTriplexMethod,
                                                          &kFaceAngleMethod,
                                                          &kIntervertexDistanceMethod,
                                                          &kSphericalScanningMethod,
                                                          &kVertexTriplexDistanceMethod,
                                                          &kFaceAngleScanningMethod};
    return kMethods;
}

CloudSubmesh cloudOf(const Submesh& submesh) {
    const Instance instance;
    return makeCloudSubmesh(submesh, {&instance, 1}, {});
}

// Rising values of the main parameter for a model about two units large.
std::vector<double> valuesFor(const CloudMethod& method) {
    switch (method.main) {
    case MainParameter::Coverage:
        return {0.1, 0.3, 0.6, 1.0, 1.5, 2.0};
    case MainParameter::AngleDeg:
        return {2.0, 5.0, 10.0, 30.0, 90.0, 180.0};
    case MainParameter::DistancePct:
        break;
    }
    return {0.02, 0.05, 0.1, 0.2, 0.4, 0.8};
}

CloudPiece pieceOf(const CloudSubmesh& cloud, const CloudMethod& method, double value) {
    CloudSettings settings;
    settings.main = value;
    settings.passes = method.main == MainParameter::AngleDeg ? 8 : 1;
    return simplifyPiece(cloud, method, settings, {});
}

LodSourcePtr prepared(std::string_view id, const ScenePtr& scene, const ParameterValues& values) {
    return findAlgorithm(id)->prepare(scene, values, {}, {}).value();
}

ScenePtr sphereScene(double scale = 1.0) {
    return meshes::sceneOf({meshes::submeshOf({meshes::sphere(24, 32)})},
                           {{glm::dmat4(glm::dmat3(scale))}});
}

// A road's slab, flat and long, as often as trees that have most of the triangles.
ScenePtr roadsAndTrees() {
    const Submesh road = meshes::submeshOf({meshes::sphere(6, 8)});
    const Submesh tree = meshes::submeshOf({meshes::sphere(24, 32)});
    const glm::dmat4 flat = glm::scale(glm::dmat4(1.0), glm::dvec3(4.0, 0.5, 2.0));
    return meshes::sceneOf({road, tree}, {std::vector(9, flat), std::vector(9, glm::dmat4(1.0))});
}

double extentOf(const Geometry& geometry) {
    Bounds bounds;
    for (const std::uint32_t index : geometry.indices)
        bounds.add(glm::dvec3(geometry.positions[index]));
    return bounds.size().y;
}

// Faces of all primitives as sorted triples of places, with the primitive.
bool hasDoubles(std::span<const GeometryPtr> primitives) {
    for (const GeometryPtr& geometry : primitives) {
        std::set<std::array<std::array<float, 3>, 3>> seen;
        for (std::size_t t = 0; t < geometry->triangleCount(); ++t) {
            std::array<std::array<float, 3>, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                const glm::vec3& p = geometry->positions[geometry->indices[3 * t + k]];
                corners[k] = {p.x, p.y, p.z};
            }
            std::rotate(corners.begin(), std::ranges::min_element(corners), corners.end());
            if (!seen.insert(corners).second)
                return true;
        }
    }
    return false;
}

} // namespace

TEST(PointCloud, CircumcentreIsEquallyFarFromAllCorners) {
    const Triangle3d points{glm::dvec3(0, 0, 1), glm::dvec3(4, 1, 0), glm::dvec3(-3, 2, 2)};
    const glm::dvec3 centre = circumcentre(points);
    const double radius = glm::distance(centre, points[0]);
    EXPECT_NEAR(glm::distance(centre, points[1]), radius, 1e-12 * radius);
    EXPECT_NEAR(glm::distance(centre, points[2]), radius, 1e-12 * radius);
    EXPECT_NEAR(glm::dot(faceVector(points), centre - points[0]), 0.0, 1e-10);
}

TEST(PointCloud, SmallestCircleOfAnObtuseTriangleIsAboutItsLongestSide) {
    const Triangle3d obtuse{glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(2, 0.5, 0)};
    EXPECT_EQ(smallestCircleCentre(obtuse), glm::dvec3(2, 0, 0));
    EXPECT_EQ(triplexCentre(obtuse, Fidelity::Literal), circumcentre(obtuse));
    const Triangle3d acute{glm::dvec3(0, 0, 0), glm::dvec3(4, 0, 0), glm::dvec3(2, 4, 0)};
    EXPECT_EQ(smallestCircleCentre(acute), circumcentre(acute));
}

TEST(PointCloud, CirclesOfDegenerateTrianglesAreFinite) {
    for (const Triangle3d& points :
         {Triangle3d{glm::dvec3(1), glm::dvec3(1), glm::dvec3(1)},
          Triangle3d{glm::dvec3(0), glm::dvec3(1), glm::dvec3(2)},
          Triangle3d{glm::dvec3(0), glm::dvec3(0), glm::dvec3(2)},
          Triangle3d{glm::dvec3(0), glm::dvec3(1e-30, 0, 0), glm::dvec3(0, 1, 0)}})
        for (const glm::dvec3& centre : {circumcentre(points), smallestCircleCentre(points)})
            EXPECT_LE(glm::length(centre), 2.0 * std::sqrt(3.0));
}

TEST(PointCloud, GridTakesExactlyWhatIsInTheBall) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
    std::vector<glm::dvec3> points(500);
    for (glm::dvec3& point : points)
        point = {coordinate(random), coordinate(random), coordinate(random)};
    for (const double radius : {0.01, 0.2, 0.7, 3.0}) {
        VertexGrid grid(points, std::vector<bool>(points.size(), false), radius);
        std::vector<std::uint32_t> taken;
        grid.takeWithin(points[7], taken);
        std::ranges::sort(taken);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t v = 0; v < points.size(); ++v)
            if (glm::distance(points[v], points[7]) < radius)
                expected.push_back(v);
        EXPECT_EQ(taken, expected);
        std::vector<std::uint32_t> again;
        grid.takeWithin(points[7], again);
        EXPECT_TRUE(again.empty());
    }
}

TEST(PointCloud, ConcavePolygonsAreTriangulatedWithoutTheirNotch) {
    const FlatPolygon notched{{{0, 0}, {4, 0}, {4, 4}, {2, 1}, {0, 4}}};
    std::vector<Triangle> triangles;
    ASSERT_TRUE(triangulate(notched, triangles));
    ASSERT_EQ(triangles.size(), 3u);
    double area = 0.0;
    for (const Triangle& t : triangles) {
        const glm::dvec2 a = notched.points[t[1]] - notched.points[t[0]];
        const glm::dvec2 b = notched.points[t[2]] - notched.points[t[0]];
        EXPECT_GT(a.x * b.y - a.y * b.x, 0.0);
        area += 0.5 * (a.x * b.y - a.y * b.x);
    }
    EXPECT_DOUBLE_EQ(area, 10.0);
}

TEST(PointCloud, PolygonsThatCrossThemselvesAreRefused) {
    std::vector<Triangle> triangles;
    EXPECT_FALSE(triangulate({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}, triangles));
}

TEST(PointCloud, ZeroIsTheIdentity) {
    const Submesh submesh = meshes::submeshOf({meshes::sphere(12, 16), meshes::soup(20)});
    const CloudSubmesh cloud = cloudOf(submesh);
    for (const CloudMethod* method : methods()) {
        const CloudPiece piece = pieceOf(cloud, *method, 0.0);
        EXPECT_FALSE(piece.changed) << method->main_id;
        EXPECT_EQ(piece.triangles, triangleCount(submesh));
        EXPECT_EQ(piece.primitives[0], submesh.primitives[0].geometry);
    }
}

TEST(PointCloud, MoreOfTheParameterLeavesNoMoreTriangles) {
    const Submesh submesh = meshes::submeshOf({meshes::sphere(40, 60)});
    const CloudSubmesh cloud = cloudOf(submesh);
    for (const CloudMethod* method : methods()) {
        const auto full = static_cast<double>(triangleCount(submesh));
        double previous = full;
        for (const double value : valuesFor(*method)) {
            const auto left = static_cast<double>(pieceOf(cloud, *method, value).triangles);
            EXPECT_LE(left, previous + 0.03 * full) << method->main_id << " " << value;
            previous = std::min(previous, left);
        }
        EXPECT_LT(previous, 0.5 * full) << method->main_id;
    }
}

TEST(PointCloud, ClosedSurfacesStayClosed) {
    for (const GeometryPtr& geometry :
         {meshes::sphere(30, 40, 0.3), meshes::torus(40, 20), meshes::sphere(6, 5)}) {
        const Submesh submesh = meshes::submeshOf({geometry});
        const CloudSubmesh cloud = cloudOf(submesh);
        for (const CloudMethod* method : methods())
            for (const double value : valuesFor(*method)) {
                const CloudPiece piece = pieceOf(cloud, *method, value);
                const meshes::Shape shape = meshes::shapeOf(piece.primitives);
                EXPECT_EQ(shape.border_edges, 0u) << method->main_id << " " << value;
                EXPECT_EQ(shape.degenerate_faces, 0u) << method->main_id << " " << value;
                EXPECT_TRUE(shape.finite);
                EXPECT_FALSE(hasDoubles(piece.primitives)) << method->main_id << " " << value;
            }
    }
}

TEST(PointCloud, CardsKeepBothTheirFaces) {
    const Submesh submesh = meshes::submeshOf({meshes::card(12)});
    const CloudSubmesh cloud = cloudOf(submesh);
    for (const CloudMethod* method :
         {&kVertexTriplexMethod, &kFaceAngleMethod, &kSphericalScanningMethod}) {
        const double value = method->main == MainParameter::DistancePct ? 0.15 : 1.0;
        const CloudPiece piece = pieceOf(cloud, *method, value);
        const meshes::Shape shape = meshes::shapeOf(piece.primitives);
        EXPECT_GT(shape.area, 1.5) << method->main_id;
    }
}

TEST(PointCloud, BothSidesOfSomethingThinStay) {
    auto lens = std::make_shared<Geometry>(*meshes::sphere(40, 60, 0.0));
    for (glm::vec3& position : lens->positions)
        position.z *= 0.02f;
    const Submesh submesh = meshes::submeshOf({lens});
    const CloudSubmesh cloud = cloudOf(submesh);
    const double area = meshes::shapeOf(std::vector<GeometryPtr>{lens}).area;
    for (const CloudMethod* method : {&kSphericalScanningMethod, &kFaceAngleScanningMethod}) {
        const CloudPiece piece = pieceOf(cloud, *method, 0.25);
        const meshes::Shape shape = meshes::shapeOf(piece.primitives);
        EXPECT_LT(piece.triangles, 300u);
        EXPECT_GT(shape.area, 0.75 * area);
        EXPECT_EQ(shape.border_edges, 0u);
        EXPECT_FALSE(hasDoubles(piece.primitives));
    }
}

TEST(PointCloud, FlatVerticesGoAndTheOutlineStays) {
    const Submesh submesh = meshes::submeshOf({meshes::grid(16)});
    const CloudSubmesh cloud = cloudOf(submesh);
    CloudSettings settings;
    settings.main = 5.0;
    settings.passes = 64;
    const CloudPiece piece = simplifyPiece(cloud, kFaceAngleMethod, settings, {});
    const meshes::Shape shape = meshes::shapeOf(piece.primitives);
    EXPECT_LT(piece.triangles, 16u);
    EXPECT_NEAR(shape.area, 1.0, 1e-5);
    EXPECT_NEAR(piece.error, 0.0, 1e-6);
}

TEST(PointCloud, LargeFacesKeepTheirVertexWhereTheAreaIsLimited) {
    const Submesh submesh = meshes::submeshOf({meshes::grid(16)});
    const CloudSubmesh cloud = cloudOf(submesh);
    CloudSettings settings;
    settings.main = 5.0;
    settings.area_share = 1e-4;
    EXPECT_FALSE(simplifyPiece(cloud, kFaceAngleMethod, settings, {}).changed);
}

TEST(PointCloud, EdgesFlipToTheDelaunayCriterion) {
    auto kite = std::make_shared<Geometry>();
    kite->positions = {{0, 0, 0}, {4, 0, 0}, {2, 1, 0}, {2, -1, 0}};
    kite->indices = {0, 1, 2, 1, 0, 3};
    const Submesh submesh = meshes::submeshOf({kite});
    CloudSurface surface = cloudOf(submesh).surface;
    flipToDelaunay(surface, {});
    EXPECT_EQ(surface.faces[0], (Triangle{0, 1, 2})); // nothing has changed there: nothing flips
    surface.changed.assign(2, 1);
    flipToDelaunay(surface, {});
    for (const Triangle& face : surface.faces) {
        EXPECT_NE(std::ranges::find(face, 2u), face.end());
        EXPECT_NE(std::ranges::find(face, 3u), face.end());
        EXPECT_GT(faceVector({glm::dvec3(kite->positions[face[0]]),
                              glm::dvec3(kite->positions[face[1]]),
                              glm::dvec3(kite->positions[face[2]])})
                      .z,
                  0.0);
    }
}

TEST(PointCloud, ThresholdsAreWorldUnitsOverTheLargestInstance) {
    const ParameterValues values{{"radius", 2.0}};
    const auto count = [&](const ScenePtr& scene) {
        return prepared("ss", scene, values)->readOut(1, nullptr).unique_triangles;
    };
    EXPECT_EQ(count(sphereScene(1.0)), count(sphereScene(50.0)));
    const Submesh sphere = meshes::submeshOf({meshes::sphere(24, 32)});
    glm::dmat4 far_away(1.0);
    far_away[3] = {100.0, 0.0, 0.0, 1.0};
    const ScenePtr wide = meshes::sceneOf({sphere}, {{glm::dmat4(1.0), far_away}});
    EXPECT_LT(count(wide), count(sphereScene()));
}

TEST(PointCloud, AGivenParameterIsUsedWhateverTheTarget) {
    const ScenePtr scene = sphereScene();
    const LodSourcePtr source = prepared("ss", scene, {{"radius", 5.0}});
    const ByteModel bytes(scene, {});
    EXPECT_EQ(source->positionCount(), 2u);
    const Resolved loose = source->resolve({Target::Kind::Ratio, 0.99}, bytes);
    const Resolved tight = source->resolve({Target::Kind::Ratio, 0.001}, bytes);
    EXPECT_EQ(loose.position, 1u);
    EXPECT_EQ(tight.position, 1u);
    EXPECT_TRUE(loose.met);
    EXPECT_FALSE(tight.met);
    EXPECT_NE(tight.note.find("radius"), std::string::npos);
}

TEST(PointCloud, NothingSinksIntoWhatItLiesOnBeforeAllIsAsCoarse) {
    const ScenePtr scene = roadsAndTrees();
    const double full = extentOf(*scene->submeshes[0].primitives[0].geometry);
    for (const std::string_view id : kIds) {
        const LodSourcePtr source = prepared(id, scene, {});
        const std::uint64_t shaped = (source->positionCount() - 1) / 2;
        for (const std::uint64_t position : {shaped / 4, shaped / 2, shaped}) {
            const Lod lod = source->readOut(position, nullptr);
            EXPECT_GE(extentOf(*lod.submeshes[0].primitives[0]), 0.4 * full) << id;
        }
        EXPECT_LE(source->trianglesAt(2 * shaped), source->trianglesAt(shaped)) << id;
    }
}

TEST(PointCloud, TargetsThatNoShapeCanBeKeptForAreMetWithoutThem) {
    const ScenePtr scene = roadsAndTrees();
    const ByteModel bytes(scene, {});
    int beyond = 0;
    for (const std::string_view id : kIds) {
        const LodSourcePtr source = prepared(id, scene, {});
        const std::uint64_t last = source->positionCount() - 1;
        const std::uint64_t least = source->trianglesAt(last);
        const auto target = static_cast<double>(least);
        EXPECT_TRUE(source->resolve({Target::Kind::Triangles, target}, bytes).met) << id;
        beyond += least < source->trianglesAt(last / 2) ? 1 : 0;
    }
    EXPECT_GT(beyond, 0);
}

TEST(PointCloud, TargetsOfEveryKindAreMet) {
    const ScenePtr scene = sphereScene();
    const ByteModel bytes(scene, {});
    const double full = static_cast<double>(countScene(*scene).triangles);
    for (const std::string_view id : kIds) {
        const LodSourcePtr source = prepared(id, scene, {});
        const Resolved triangles = source->resolve({Target::Kind::Triangles, 500.0}, bytes);
        EXPECT_TRUE(triangles.met) << id;
        EXPECT_LE(source->trianglesAt(triangles.position), 500u) << id;
        EXPECT_GE(source->trianglesAt(triangles.position), 300u) << id;
        const double half = 0.5 * static_cast<double>(bytes.bytes(source->shapeAt(0)));
        const Resolved size = source->resolve({Target::Kind::Bytes, half}, bytes);
        EXPECT_TRUE(size.met) << id;
        EXPECT_LE(static_cast<double>(bytes.bytes(source->shapeAt(size.position))), half) << id;
        const Resolved error = source->resolve({Target::Kind::Error, 8.0}, bytes);
        EXPECT_LE(source->errorAt(error.position), 8.0) << id;
        EXPECT_EQ(source->resolve({Target::Kind::Ratio, 1.0}, bytes).position, 0u) << id;
        EXPECT_LT(static_cast<double>(source->trianglesAt(error.position)), full) << id;
    }
}

TEST(PointCloud, SourcesOfOneSceneShareItsWeldsAndDifferInNothing) {
    const ScenePtr scene = sphereScene();
    const LodSourcePtr other = prepared("vt", scene, {});
    const LodSourcePtr foreign = prepared("ias", scene, {});
    for (const std::string_view id : kIds) {
        const LodSourcePtr alone = prepared(id, scene, {});
        for (const LodSourcePtr& from : {other, foreign}) {
            const LodSourcePtr like = findAlgorithm(id)->prepareLike(*from, {}, {}, {}).value();
            EXPECT_EQ(like->scene(), scene);
            for (const std::uint64_t position : {1000u, 2000u, 3000u}) {
                const Lod expected = alone->readOut(position, nullptr);
                const Lod lod = like->readOut(position, nullptr);
                EXPECT_EQ(lod.submeshes[0].primitives[0]->indices,
                          expected.submeshes[0].primitives[0]->indices)
                    << id;
            }
        }
    }
}

TEST(PointCloud, CountsAreThoseOfTheGeometryThatIsReadOut) {
    const Submesh sphere = meshes::submeshOf({meshes::sphere(24, 32)});
    const Submesh card = meshes::submeshOf({meshes::card(12)});
    const ScenePtr scene = meshes::sceneOf({sphere, card}, {{glm::dmat4(1.0)}, {glm::dmat4(1.0)}});
    for (const std::string_view id : kIds) {
        const LodSourcePtr source = prepared(id, scene, {});
        for (const std::uint64_t position : {0u, 500u, 1000u, 2500u, 4096u, 6500u, 8192u}) {
            const std::uint64_t triangles = source->trianglesAt(position);
            const LodShape shape = source->shapeAt(position);
            const Lod lod = source->readOut(position, nullptr);
            EXPECT_EQ(triangles, lod.triangles) << id;
            const LodShape made = shapeOf(*scene, lod);
            for (std::size_t s = 0; s < 2; ++s) {
                EXPECT_EQ(shape.submeshes[s].changed, made.submeshes[s].changed);
                EXPECT_EQ(shape.submeshes[s].primitives[0].vertices,
                          made.submeshes[s].primitives[0].vertices);
                EXPECT_EQ(shape.submeshes[s].primitives[0].indices,
                          made.submeshes[s].primitives[0].indices);
            }
        }
    }
}

TEST(PointCloud, LockedSubmeshesStayAndImportantOnesKeepMore) {
    const Submesh sphere = meshes::submeshOf({meshes::sphere(24, 32)});
    const ScenePtr scene =
        meshes::sceneOf({sphere, sphere}, {{glm::dmat4(1.0)}, {glm::dmat4(1.0)}});
    for (const std::string_view id : {"ss", "ivdd", "vt", "fad"}) {
        const Algorithm& row = *findAlgorithm(id);
        ScheduleOptions locked;
        locked.locked = {false, true};
        const LodSourcePtr source = row.prepare(scene, {}, locked, {}).value();
        const Lod lod = source->readOut(source->positionCount() / 2, nullptr);
        EXPECT_EQ(lod.submeshes[1].primitives[0], scene->submeshes[1].primitives[0].geometry);
        ScheduleOptions weighed;
        weighed.importance = {1.0, 4.0};
        const LodSourcePtr other = source->rescheduled(weighed, ByteModel(scene, {}));
        const ByteModel bytes(scene, {});
        const Lod half =
            other->readOut(other->resolve({Target::Kind::Ratio, 0.5}, bytes).position, nullptr);
        EXPECT_LT(half.submeshes[0].primitives[0]->triangleCount(),
                  half.submeshes[1].primitives[0]->triangleCount())
            << id;
    }
}

} // namespace lodestone
