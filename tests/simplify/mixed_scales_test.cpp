// Scenes whose instances differ a thousandfold in size, mirrored, sheared and nested.
#include "scene/scene_builder.h"
#include "simplify/algorithm.h"
#include "simplify/measure/distance.h"
#include "tests/simplify/meshes.h"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>
#include <random>

using namespace lodestone;

namespace {

constexpr std::uint32_t kRock = 0;
constexpr std::uint32_t kPebble = 1;
constexpr std::uint32_t kTower = 2;
constexpr std::uint32_t kLeaf = 3;

using Engine = std::mt19937;

double between(Engine& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

// Turned any way; one in four mirrored, one in five sheared.
glm::dmat4 place(Engine& random, double spread, double size) {
    const glm::dvec3 at(between(random, -spread, spread),
                        between(random, -spread, spread),
                        between(random, -spread, spread));
    glm::dmat4 matrix = glm::translate(glm::dmat4(1.0), at);
    matrix = glm::rotate(matrix, between(random, 0.0, 6.0), {0.48, 0.6, 0.64});
    const double mirror = random() % 4 == 0 ? -1.0 : 1.0;
    matrix = glm::scale(matrix, {size * mirror, size * between(random, 0.7, 1.4), size});
    glm::dmat4 shear(1.0);
    shear[1][0] = random() % 5 == 0 ? 0.6 : 0.0;
    return matrix * shear;
}

// A rock of size 100 and `per_submesh` - 1 of sizes from 0.1 to 1, pebbles of sizes from 0.1 to 10,
// a tower, leaves; four to a node, which has a size of its own.
ScenePtr mixedScene(std::uint32_t per_submesh) {
    Engine random(per_submesh);
    SceneBuilder builder("mixed " + std::to_string(per_submesh));
    for (const GeometryPtr& geometry :
         {meshes::sphere(16, 24), meshes::sphere(8, 12), meshes::sphere(24, 32), meshes::grid(3)})
        builder.addSubmesh(meshes::submeshOf({geometry}));
    builder.addNode("the rock", kNone, place(random, 1.0, 100.0), kRock);
    builder.addNode("the tower", kNone, place(random, 50.0, 20.0), kTower);
    std::uint32_t group = kNone;
    for (std::uint32_t i = 0; i < per_submesh; ++i) {
        if (i % 4 == 0) {
            const std::uint32_t outer = builder.addNode("outer", kNone, place(random, 100.0, 0.1));
            group = builder.addNode("inner", outer, place(random, 10.0, 10.0));
        }
        const auto decades = [&](double low, double high) {
            return std::pow(10.0, between(random, low, high));
        };
        if (i > 0)
            builder.addNode("rock", group, place(random, 20.0, decades(-1.0, 0.0)), kRock);
        builder.addNode("pebble", group, place(random, 20.0, decades(-1.0, 1.0)), kPebble);
        builder.addNode("leaf", group, place(random, 20.0, decades(-1.0, 0.5)), kLeaf);
    }
    return builder.finish();
}

LodSourcePtr prepared(const char* algorithm, const ScenePtr& scene) {
    return *findAlgorithm(algorithm)->prepare(scene, {}, {}, {});
}

std::vector<std::uint64_t> somePositions(const LodSource& source, std::uint64_t count) {
    std::vector<std::uint64_t> positions;
    for (std::uint64_t i = 0; i <= count; ++i)
        positions.push_back((source.positionCount() - 1) * i / count);
    return positions;
}

// Six times the volume that the faces enclose; negative where they face inwards.
double signedVolume(const Geometry& geometry) {
    double volume = 0.0;
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) {
            return glm::dvec3(geometry.positions[geometry.indices[i + k]]);
        };
        volume += glm::dot(corner(0), glm::cross(corner(1), corner(2)));
    }
    return volume;
}

// Faces of a mesh that is seen whole from its origin which turn their back outwards.
std::uint64_t facesInwards(const Geometry& geometry) {
    std::uint64_t inwards = 0;
    for (std::size_t i = 0; i < geometry.indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) {
            return glm::dvec3(geometry.positions[geometry.indices[i + k]]);
        };
        const glm::dvec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
        inwards += glm::dot(normal, corner(0) + corner(1) + corner(2)) < 0.0 ? 1U : 0U;
    }
    return inwards;
}

class MixedScales : public ::testing::TestWithParam<std::uint32_t> {
protected:
    ScenePtr scene_ = mixedScene(GetParam());
    LodSourcePtr source_ = prepared("ias", scene_);
};

} // namespace

TEST_P(MixedScales, TargetsAreMetByTheFirstPositionThatFits) {
    const ByteModel bytes(scene_, {});
    for (const double ratio : {0.7, 0.4, 0.2, 0.1}) {
        const Resolved resolved = source_->resolve({Target::Kind::Ratio, ratio}, bytes);
        ASSERT_TRUE(resolved.met) << ratio << ": " << resolved.note;
        const double limit = ratio * static_cast<double>(source_->trianglesAt(0));
        EXPECT_LE(static_cast<double>(source_->trianglesAt(resolved.position)), limit);
        EXPECT_GT(static_cast<double>(source_->trianglesAt(resolved.position - 1)), limit);
    }
}

TEST_P(MixedScales, NoSubmeshVanishes) {
    for (const std::uint64_t position : somePositions(*source_, 40)) {
        const Lod lod = source_->readOut(position, nullptr);
        for (const LodSubmesh& submesh : lod.submeshes) {
            EXPECT_GE(submesh.kept_instances, 1U) << "position " << position;
            EXPECT_GE(submesh.primitives[0]->triangleCount(), 4U) << "position " << position;
        }
    }
}

// A collapse turns no face by more than its limit, but several collapses may.
TEST_P(MixedScales, HardlyAFaceTurnsInwards) {
    std::uint64_t faces = 0;
    std::uint64_t inwards = 0;
    for (const std::uint64_t position : somePositions(*source_, 400)) {
        const Lod lod = source_->readOut(position, nullptr);
        for (const std::uint32_t s : {kRock, kPebble, kTower}) {
            const Geometry& geometry = *lod.submeshes[s].primitives[0];
            EXPECT_GT(signedVolume(geometry), 0.0) << "submesh " << s << ", position " << position;
            if (geometry.triangleCount() < 24)
                continue;
            faces += geometry.triangleCount();
            inwards += facesInwards(geometry);
            EXPECT_LE(24U * facesInwards(geometry), geometry.triangleCount())
                << "submesh " << s << ", position " << position;
        }
    }
    EXPECT_LE(5000U * inwards, faces);
}

TEST_P(MixedScales, TheSizeFallsWithEveryStepHoweverItIsStored) {
    for (const Instancing instancing :
         {Instancing::Auto, Instancing::Nodes, Instancing::Gpu, Instancing::Expand}) {
        const ByteModel bytes(scene_, {instancing});
        std::uint64_t before = ~std::uint64_t{0};
        std::uint64_t triangles_before = 0;
        for (const std::uint64_t position : somePositions(*source_, 40)) {
            const std::uint64_t triangles = source_->trianglesAt(position);
            if (triangles == triangles_before)
                continue;
            const std::uint64_t size = bytes.bytes(source_->shapeAt(position));
            EXPECT_LT(size, before)
                << "instancing " << static_cast<int>(instancing) << ", position " << position;
            before = size;
            triangles_before = triangles;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(InstancesPerSubmesh, MixedScales, ::testing::Values(1U, 5U, 50U, 1000U));

// The rock has one instance of size 100 among 49 that are a hundredth of it; the pebbles are many.
TEST(MixedScalesOf, SizesOfInstancesCount) {
    const ScenePtr scene = mixedScene(50);
    const ByteModel bytes(scene, {});
    const Lod full = fullLod(*scene);
    const auto halved = [&](const char* algorithm) {
        const LodSourcePtr source = prepared(algorithm, scene);
        return source->readOut(source->resolve({Target::Kind::Ratio, 0.5}, bytes).position,
                               nullptr);
    };
    const auto mean = [&](const Lod& lod) {
        return measureDistance({scene.get(), &full}, {scene.get(), &lod}, {50'000}, {})->mean;
    };
    EXPECT_LT(mean(halved("ias")), 0.5 * mean(halved("quadric-submesh")));
}
