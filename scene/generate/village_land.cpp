// Street furniture, trees, meadows, and the ground itself.
#include "scene/generate/village_builder.h"

#include <algorithm>
#include <cmath>

namespace lodestone::generate {

namespace {

constexpr std::size_t kInstances = 13523;
constexpr std::size_t kTriangles = 1254696;

} // namespace

void VillageBuilder::placeStreetFurniture() {
    const std::uint32_t group = sample_.addGroup("street furniture");
    for (const Road& road : roads_)
        for (std::size_t i = 20; i + 20 < road.points.size(); i += road.main ? 18 : 26) {
            const RoadPoint& p = road.points[i];
            const double side = i / 2 % 2 == 0 ? 1.0 : -1.0;
            const glm::dvec2 at = p.at + leftOf(p.heading) * (side * (kRoadHalfWidth + 0.6));
            if (!clearOfRoads(at, 0.4) || glm::length(at) > 150.0)
                continue;
            const Trs trs{onGround(at.x, at.y), facing(p.heading), glm::dvec3(1.0)};
            sample_.place(lamp_, trs, group);
            sample_.place(glass_, trs, group);
        }
    for (int b = 0; b < 8; ++b) { // around the well on the square
        const double a = 2.0 * kPi * (b + 0.5) / 8.0;
        const glm::dvec2 out(cosine(a), sine(a));
        const glm::dvec2 at = out * 10.5;
        sample_.place(
            bench_,
            {onGround(at.x, at.y) + glm::dvec3(0, 0.15, 0), facing(-out), glm::dvec3(1.0)},
            group);
        const glm::dvec2 lamp = out * 13.5;
        if (b % 2 == 0) {
            const Trs trs{onGround(lamp.x, lamp.y), facing(out), glm::dvec3(1.0)};
            sample_.place(lamp_, trs, group);
            sample_.place(glass_, trs, group);
        }
    }
    const Trs well{onGround(4.0, 5.5) + glm::dvec3(0, 0.15, 0), yaw(0.4), glm::dvec3(1.0)};
    sample_.place(well_, well, group);
    sample_.place(well_roof_, well, group);
    for (const std::size_t i : {std::size_t{18}, std::size_t{48}, roads_[0].points.size() - 30}) {
        const RoadPoint& p = roads_[0].points[i]; // by the fields
        const glm::dvec2 at = p.at + leftOf(p.heading) * (kRoadHalfWidth + 2.6);
        along(cart_, at, leftOf(p.heading), group);
        sites_.take(at, 3.0);
    }
    for (const double a : {0.2, 2.7}) { // and on the square
        const glm::dvec2 at = glm::dvec2(cosine(a), sine(a)) * 8.5;
        sample_.place(
            cart_,
            {onGround(at.x, at.y) + glm::dvec3(0, 0.13, 0), yaw(3.0 * a), glm::dvec3(1.0)},
            group);
    }
}

void VillageBuilder::placeFieldWalls() {
    const std::uint32_t group = sample_.addGroup("field walls");
    for (const Road& road : roads_)
        for (std::size_t i = 0; i < road.points.size(); i += 2)
            for (const double side : {-1.0, 1.0}) {
                const RoadPoint& p = road.points[i];
                const glm::dvec2 at = p.at + leftOf(p.heading) * (side * (kRoadHalfWidth + 1.8));
                if (glm::length(at) > 128.0 && clearOfRoads(at, 1.2) && sites_.isFree(at, 1.2)) {
                    along(wall_, at, p.heading, group);
                    sites_.take(at, 0.8);
                }
            }
}

void VillageBuilder::placeTree(const Tree& tree, const glm::dvec2& at, double scale) {
    const Trs trs{onGround(at.x, at.y), yaw(random_.in(0.0, 2.0 * kPi)), glm::dvec3(scale)};
    sample_.place(tree.trunk, trs, garden_group_);
    sample_.place(tree.crown, trs, garden_group_);
}

void VillageBuilder::placeTrees() {
    constexpr int kTrees = 560;
    for (int placed = 0; placed < kTrees;) {
        const glm::dvec2 at(random_.in(-184.0, 184.0), random_.in(-184.0, 184.0));
        const double far = glm::length(at);
        // Woods: spruce on the hills, broad leaves in clumps nearer by.
        const double wood =
            noise({at.x * 0.025, 3.0, at.y * 0.025}, 41) + smoothStep(90.0, 190.0, far) * 0.9;
        if (random_.in(-0.25, 1.2) > wood)
            continue;
        const bool fir = random_.unit() < smoothStep(95.0, 165.0, far);
        const std::size_t kind = fir ? 2 : (random_.below(4) == 0 ? 1 : 0);
        const double u = random_.unit();
        const double scale =
            far < 100.0 ? 0.35 + 0.9 * u : 0.3 + 1.3 * u * u + (u > 0.97 ? 1.6 : 0.0);
        const double room = 1.5 * scale;
        if (!clearOfRoads(at, 1.0 + 1.6 * scale) || !sites_.isFree(at, room))
            continue;
        sites_.take(at, room);
        placeTree(trees_[kind], at, scale);
        ++placed;
    }
    for (const double side : {-1.0, 1.0}) // an avenue of poplars at both ends of the main road
        for (std::size_t i = 0; i < roads_[0].points.size(); i += 7) {
            const RoadPoint& p = roads_[0].points[i];
            const glm::dvec2 at = p.at + leftOf(p.heading) * (side * (kRoadHalfWidth + 4.0));
            if (glm::length(at) > 132.0 && clearOfRoads(at, 2.0) && sites_.isFree(at, 1.0)) {
                sites_.take(at, 1.0);
                placeTree(trees_[3], at, random_.in(0.9, 1.2));
            }
        }
    for (const glm::dvec2& at : {glm::dvec2(-9.5, 19.0), glm::dvec2(-148.0, 150.0)})
        placeTree(trees_[0], at, at.x < -100.0 ? 4.0 : 1.7); // the old lime, and the giant
}

void VillageBuilder::placeUndergrowth() {
    const std::uint32_t group = sample_.addGroup("meadow");
    for (int placed = 0; placed < 420;) {
        const glm::dvec2 at(random_.in(-186.0, 186.0), random_.in(-186.0, 186.0));
        if (!clearOfRoads(at, 1.5) || !sites_.isFree(at, 1.0))
            continue;
        const double u = random_.unit();
        const double scale = 0.25 + 1.6 * u * u * u;
        const bool rock = placed % 2 == 0;
        sample_.place(rock ? rock_ : bushes_[0],
                      {onGround(at.x, at.y),
                       yaw(random_.in(0.0, 6.28)),
                       glm::dvec3(rock ? scale : 0.8 + scale)},
                      group);
        ++placed;
    }
    // Grass takes whatever is left to the exact number; the ground comes last.
    while (sample_.instanceCount() + 1 < kInstances) {
        const glm::dvec2 at(random_.in(-186.0, 186.0), random_.in(-186.0, 186.0));
        if (!clearOfRoads(at, 0.5) || !sites_.isFree(at, 0.3))
            continue;
        const bool dry = noise({at.x * 0.04, 0.0, at.y * 0.04}, 61) > 0.1;
        sample_.place(
            undergrowth_[dry ? 1 : 0],
            {onGround(at.x, at.y), yaw(random_.in(0.0, 6.28)), glm::dvec3(random_.in(0.7, 1.7))},
            group);
    }
}

void VillageBuilder::placeGround() {
    const std::size_t missing = kTriangles - sample_.triangleCount();
    Mesh mesh;
    const auto cells = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(missing) / 2.0));
    for (std::uint32_t i = 0; i <= cells; ++i)
        for (std::uint32_t j = 0; j <= cells; ++j)
            mesh.addVertex(
                {kLandHalf * (2.0 * j / cells - 1.0), 0.0, kLandHalf * (2.0 * i / cells - 1.0)});
    const std::uint32_t row = cells + 1;
    for (std::uint32_t i = 0; i < cells; ++i)
        for (std::uint32_t j = 0; j < cells; ++j) {
            const std::uint32_t v = i * row + j;
            mesh.addQuad(v, v + row, v + row + 1, v + 1);
        }
    refineTo(mesh, missing);
    for (glm::dvec3& p : mesh.positions)
        p.y = groundHeight(p.x, p.z);
    const std::uint32_t ground = sample_.add("ground", mesh, kPi, {0x7D8F4B, 1.0});
    sample_.place(ground, Trs{}, sample_.addGroup("land"));
}

} // namespace lodestone::generate
