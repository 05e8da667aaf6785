#include "scene/generate/village_houses.h"

#include <algorithm>

namespace lodestone::generate {

namespace {

constexpr double kNaveWidth = 9.0;
constexpr double kNaveLength = 18.0;
constexpr double kNaveHeight = 7.0;
constexpr double kNaveRise = 5.0;
constexpr double kTower = 5.4; // width
constexpr double kTowerHeight = 19.0;
constexpr double kTowerZ = kNaveLength / 2.0 + kTower / 2.0 - 0.6;

// Pointed arch, closed, standing at the origin and facing +z.
Mesh arch(double width, double height, double thickness) {
    Ring outline{{-width / 2.0, 0.0, 0.0}, {width / 2.0, 0.0, 0.0}};
    constexpr int kSteps = 4;
    const double shoulder = height - width * 0.9;
    for (int s = 0; s <= kSteps; ++s) {
        const double a = kPi / 3.0 * s / kSteps;
        outline.emplace_back(-width / 2.0 + width * cosine(a), shoulder + width * sine(a), 0.0);
    }
    for (int s = kSteps - 1; s >= 0; --s) {
        const double a = kPi / 3.0 * s / kSteps;
        outline.emplace_back(width / 2.0 - width * cosine(a), shoulder + width * sine(a), 0.0);
    }
    Ring front = outline;
    for (glm::dvec3& p : front)
        p.z = thickness;
    Mesh mesh;
    addLoft(mesh, std::array{outline, front});
    return mesh;
}

void addWalls(Mesh& mesh) {
    const double x = kNaveWidth / 2.0;
    const double z = kNaveLength / 2.0;
    Ring back{{-x, -2.5, -z},
              {x, -2.5, -z},
              {x, kNaveHeight, -z},
              {0.0, kNaveHeight + kNaveRise, -z},
              {-x, kNaveHeight, -z}};
    Ring front = back;
    for (glm::dvec3& p : front)
        p.z = z;
    addLoft(mesh, std::array{back, front});
    addBox(mesh, {-x - 0.15, -2.5, -z - 0.15}, {x + 0.15, 0.7, z - 0.2});
    for (const double side : {-1.0, 1.0})
        for (int b = 0; b < 5; ++b) { // buttresses
            const double at = -z + 0.5 + b * (kNaveLength - 1.8) / 4.0;
            const glm::dvec3 foot(side * (x + 0.45), 0.0, at);
            addBox(mesh, foot + glm::dvec3(-0.55, -2.5, -0.4), foot + glm::dvec3(0.55, 3.6, 0.4));
            addBox(mesh,
                   foot + glm::dvec3(-0.5 - 0.15 * side, 3.6, -0.32),
                   foot + glm::dvec3(0.5 - 0.15 * side, 5.6, 0.32));
        }
    const double t = kTower / 2.0;
    const auto stage = [&](double low, double high, double out) {
        addBox(mesh, {-t - out, low, kTowerZ - t - out}, {t + out, high, kTowerZ + t + out});
    };
    stage(-2.5, 1.0, 0.3);
    stage(1.0, 7.5, 0.12);
    stage(7.5, 7.9, 0.3);
    stage(7.9, 13.0, 0.05);
    stage(13.0, 13.4, 0.25);
    stage(13.4, kTowerHeight - 0.5, 0.0);
    stage(kTowerHeight - 0.5, kTowerHeight, 0.35);
    for (const double sx : {-1.0, 1.0})
        for (const double sz : {-1.0, 1.0}) { // pinnacles
            const glm::dvec3 at(sx * (t + 0.05), kTowerHeight, kTowerZ + sz * (t + 0.05));
            Mesh pinnacle;
            addTurned(
                pinnacle, std::array<glm::dvec2, 3>{{{0.38, -0.1}, {0.34, 0.9}, {0.03, 2.4}}}, 4);
            mesh.append(pinnacle, moved(at) * rotatedY(kPi / 4.0));
        }
}

void addRoofs(Mesh& mesh) {
    addGableRoof(mesh,
                 {kNaveLength + 0.5, kNaveWidth / 2.0, kNaveRise, 0.4, 10},
                 moved({0.0, kNaveHeight, -0.5}) * rotatedY(kPi / 2.0));
    Mesh spire;
    const std::array<glm::dvec2, 6> profile{
        {{3.0, -0.05}, {2.75, 0.35}, {2.1, 2.0}, {1.4, 6.0}, {0.7, 10.5}, {0.04, 15.0}}};
    addTurned(spire, profile, 8);
    addBox(spire, {-0.07, 14.9, -0.07}, {0.07, 16.9, 0.07}); // the cross
    addBox(spire, {-0.55, 16.1, -0.065}, {0.55, 16.26, 0.065});
    mesh.append(spire, moved({0.0, kTowerHeight, kTowerZ}) * rotatedY(kPi / 8.0));
}

void addWindows(Mesh& mesh) {
    const Mesh lancet = arch(1.1, 3.6, 0.14);
    for (const double side : {-1.0, 1.0})
        for (int b = 0; b < 4; ++b) {
            const double at = -kNaveLength / 2.0 + 0.5 + (b + 0.5) * (kNaveLength - 1.8) / 4.0;
            mesh.append(lancet,
                        moved({side * (kNaveWidth / 2.0 - 0.05), 1.9, at}) *
                            rotatedY(side * kPi / 2.0));
        }
    const Mesh belfry = arch(1.0, 3.0, 0.12);
    for (int face = 0; face < 4; ++face)
        for (const double x : {-1.0, 1.0})
            mesh.append(belfry,
                        moved({0.0, 14.4, kTowerZ}) * rotatedY(face * kPi / 2.0) *
                            moved({x, 0.0, kTower / 2.0 - 0.05}));
    mesh.append(arch(1.9, 3.4, 0.2), moved({0.0, -0.2, kTowerZ + kTower / 2.0 + 0.05}));
    mesh.append(arch(1.3, 3.2, 0.12), moved({0.0, 8.9, kTowerZ + kTower / 2.0}));
    mesh.append(arch(2.2, 5.2, 0.12), moved({0.0, 2.0, -kNaveLength / 2.0 + 0.05}) * rotatedY(kPi));
}

} // namespace

Church makeChurch() {
    Church church;
    addWalls(church.walls);
    addRoofs(church.roof);
    addWindows(church.windows);
    return church;
}

} // namespace lodestone::generate
