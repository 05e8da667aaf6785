#include "tests/simplify/damaged_meshes.h"

#include "scene/finite.h"
#include "simplify/wild/wild.h"
#include "tests/simplify/meshes.h"

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace lodestone::meshes {

namespace {

// Damages a mesh in every way that a seed picks.
class Defects {
public:
    explicit Defects(unsigned seed) : random_(seed) {}

    GeometryPtr make() {
        switch (random_() % 5) {
        case 0:
            take(*soup(1100 + int(random_() % 900)));
            break;
        case 1:
            take(*sphere(20, 30));
            break;
        case 2:
            take(*torus(40, 20));
            break;
        case 3:
            take(*card(16));
            break;
        default:
            manyParts();
        }
        for (int round = 0; round < 3; ++round)
            damage();
        while (to_.indices.size() <= std::size_t{3} * 1000)
            take(*moved(sphere(10, 12), {double(random_() % 7), 0.5, 0.25}));
        return std::make_shared<const Geometry>(to_);
    }

private:
    void take(const Geometry& from) {
        const auto first = static_cast<std::uint32_t>(to_.positions.size());
        to_.positions.insert(to_.positions.end(), from.positions.begin(), from.positions.end());
        for (const std::uint32_t index : from.indices)
            to_.indices.push_back(first + index);
    }

    void manyParts() {
        const int parts = 600 + int(random_() % 1500);
        for (int i = 0; i < parts; ++i) {
            const double spread = 10.0;
            take(*moved(grid(1),
                        {spread * share(), spread * share(), random_() % 3 ? 0.0 : share()}));
        }
    }

    double share() { return double(random_() % 10'000) / 10'000.0; }

    std::size_t someTriangle() { return 3 * (random_() % (to_.indices.size() / 3)); }

    void damage() {
        const std::size_t count = to_.indices.size() / 3 / 8 + 1;
        const std::uint64_t kind = random_() % 6;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t t = someTriangle();
            std::uint32_t* corner = to_.indices.data() + t;
            switch (kind) {
            case 0: // turned over
                std::swap(corner[0], corner[1]);
                break;
            case 1: // twice, and once more the other way
                to_.indices.insert(to_.indices.end(), {corner[0], corner[1], corner[2]});
                to_.indices.insert(to_.indices.end(),
                                   {to_.indices[t + 1], to_.indices[t], to_.indices[t + 2]});
                break;
            case 2: // no area: two corners at one place
                to_.positions[corner[0]] = to_.positions[corner[1]];
                break;
            case 3: // no area: three corners on a line
                to_.positions[corner[2]] =
                    0.5f * (to_.positions[corner[0]] + to_.positions[corner[1]]);
                break;
            case 4: { // T-junction: one side is split, its neighbour does not know
                const glm::vec3 middle =
                    0.5f * (to_.positions[corner[0]] + to_.positions[corner[1]]);
                const auto fresh = static_cast<std::uint32_t>(to_.positions.size());
                to_.positions.push_back(middle);
                to_.indices.insert(to_.indices.end(), {fresh, corner[1], corner[2]});
                to_.indices[t + 1] = fresh;
                break;
            }
            default: // a corner that belongs to another part altogether
                corner[0] = to_.indices[someTriangle()];
            }
        }
    }

    std::mt19937 random_;
    Geometry to_;
};

} // namespace

GeometryPtr damagedMesh(unsigned seed) {
    return Defects(seed).make();
}

void expectWildReachesAThousandth(const ScenePtr& scene) {
    const Result<LodSourcePtr> source =
        wildAlgorithm().prepare(scene, {{"floors", 0.0}, {"scope", 2.0}}, {}, {});
    ASSERT_TRUE(source) << source.error().message;
    const ByteModel bytes((*source)->scene(), {});
    const Resolved at = (*source)->resolve({Target::Kind::Ratio, 0.001}, bytes);
    EXPECT_TRUE(at.met) << at.note;
    const Lod lod = (*source)->readOut(at.position, nullptr);
    EXPECT_LE(static_cast<double>(lod.triangles),
              0.001 * static_cast<double>((*source)->trianglesAt(0)));
    for (const LodSubmesh& submesh : lod.submeshes)
        for (const GeometryPtr& geometry : submesh.primitives) {
            for (const glm::vec3& p : geometry->positions)
                ASSERT_TRUE(isFinite(p));
            for (const std::uint32_t index : geometry->indices)
                ASSERT_LT(index, geometry->positions.size());
        }
}

} // namespace lodestone::meshes
