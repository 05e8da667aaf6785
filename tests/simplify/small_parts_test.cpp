// What may vanish from a mesh of many parts, and what may not.
#include "simplify/algorithm.h"
#include "tests/simplify/meshes.h"

#include <gtest/gtest.h>

namespace lodestone {

namespace {

constexpr double kLarge = 1.0; // radii
constexpr double kMedium = 0.2;
constexpr double kSpeck = 0.001;
constexpr int kSpecks = 40;
constexpr double kReach = 1.3; // of a bumpy sphere, radii

GeometryPtr sphereAt(const glm::dvec3& centre, double radius, int rings) {
    auto scaled = std::make_shared<Geometry>(*meshes::sphere(rings, rings + 4));
    for (glm::vec3& p : scaled->positions)
        p = glm::vec3(centre + radius * glm::dvec3(p));
    return scaled;
}

glm::dvec3 speckCentre(int i) {
    return {-2.0 + 0.1 * i, 1.6, 0.05 * (i % 7)};
}

const glm::dvec3 kMediumCentre{1.6, 0.0, 0.0};

// One geometry of a large part, a medium one, and specks that have two thirds of the triangles.
ScenePtr partsScene() {
    auto all = std::make_shared<Geometry>();
    const auto add = [&](const GeometryPtr& part) {
        const auto first = static_cast<std::uint32_t>(all->positions.size());
        all->positions.insert(all->positions.end(), part->positions.begin(), part->positions.end());
        for (const std::uint32_t index : part->indices)
            all->indices.push_back(first + index);
    };
    add(sphereAt({}, kLarge, 24));
    add(sphereAt(kMediumCentre, kMedium, 16));
    for (int i = 0; i < kSpecks; ++i)
        add(sphereAt(speckCentre(i), kSpeck, 8));
    return meshes::sceneOf({meshes::submeshOf({all})}, {{glm::dmat4(1.0)}});
}

// The triangles of a LOD around a place.
struct Part {
    std::size_t triangles = 0;
    double area = 0.0;
};

Part partAt(const Lod& lod, const glm::dvec3& centre, double radius) {
    Part part;
    for (const GeometryPtr& geometry : lod.submeshes[0].primitives)
        for (std::size_t i = 0; i < geometry->indices.size(); i += 3) {
            std::array<glm::dvec3, 3> corner;
            for (std::size_t k = 0; k < 3; ++k)
                corner[k] = geometry->positions[geometry->indices[i + k]];
            if (glm::length((corner[0] + corner[1] + corner[2]) / 3.0 - centre) > kReach * radius)
                continue;
            ++part.triangles;
            part.area +=
                0.5 * glm::length(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
        }
    return part;
}

std::size_t trianglesOfSpecks(const Lod& lod) {
    std::size_t triangles = 0;
    for (int i = 0; i < kSpecks; ++i)
        triangles += partAt(lod, speckCentre(i), kSpeck).triangles;
    return triangles;
}

void expectSpecksGoAndTheRestStays(std::string_view id, const Target& target) {
    const ScenePtr scene = partsScene();
    const Lod full = fullLod(*scene);
    const LodSourcePtr source = findAlgorithm(id)->prepare(scene, {}, {}, {}).value();
    const std::uint64_t position = source->resolve(target, ByteModel(scene, {})).position;
    const Lod lod = source->readOut(position, nullptr);
    EXPECT_LT(trianglesOfSpecks(lod), trianglesOfSpecks(full) / 20) << id;
    EXPECT_GE(partAt(lod, {}, kLarge).area, 0.95 * partAt(full, {}, kLarge).area) << id;
    EXPECT_GE(partAt(lod, kMediumCentre, kMedium).area,
              0.95 * partAt(full, kMediumCentre, kMedium).area)
        << id;
}

constexpr std::array<std::string_view, 4> kIds{"quadric", "quadric-submesh", "ias", "wild"};

} // namespace

TEST(SmallParts, SpecksVanishBeforeLargePartsLoseArea) {
    for (const std::string_view id : kIds)
        expectSpecksGoAndTheRestStays(id, {Target::Kind::Ratio, 0.12});
}

TEST(SmallParts, SpecksBelowTheErrorVanishAndLargePartsKeepTheirArea) {
    for (const std::string_view id : kIds)
        expectSpecksGoAndTheRestStays(id, {Target::Kind::Error, 0.15});
}

TEST(SmallParts, TheLargestPartIsLeftAtTheVeryEnd) {
    const ScenePtr scene = partsScene();
    for (const std::string_view id : kIds) {
        const LodSourcePtr source = findAlgorithm(id)->prepare(scene, {}, {}, {}).value();
        const Lod lod = source->readOut(source->positionCount() - 1, nullptr);
        EXPECT_GE(partAt(lod, {}, kLarge).triangles, 4u) << id;
    }
}

} // namespace lodestone
