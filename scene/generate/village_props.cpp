#include "scene/generate/village_props.h"

#include <algorithm>

namespace lodestone::generate {

namespace {

using Box = std::array<glm::dvec3, 2>;

Mesh boxes(std::initializer_list<Box> list) {
    Mesh mesh;
    for (const Box& box : list)
        addBox(mesh, box[0], box[1]);
    return mesh;
}

// A bar with a square section between two points.
void addBeam(Mesh& mesh, const glm::dvec3& from, const glm::dvec3& to, double width) {
    addTube(mesh, std::array<PathPoint, 2>{{{from, width * 0.7}, {to, width * 0.7}}}, 4);
}

// A wheel about the x axis.
Mesh wheel(double radius) {
    Mesh mesh;
    constexpr int kSides = 16;
    std::vector<Ring> rings(5);
    for (int s = 0; s < kSides; ++s) { // the rim: a closed ring, lofted around its section
        const double a = 2.0 * kPi * s / kSides;
        const std::array<glm::dvec2, 4> section{
            {{-0.05, radius}, {0.05, radius}, {0.05, radius - 0.11}, {-0.05, radius - 0.11}}};
        for (std::size_t k = 0; k < 5; ++k)
            rings[k].emplace_back(
                section[k % 4].x, section[k % 4].y * cosine(a), section[k % 4].y * sine(a));
    }
    // Four bands between the four circles; the last ring of the loft is the first one again.
    for (std::size_t k = 0; k < 4; ++k)
        for (int s = 0; s < kSides; ++s)
            mesh.addVertex(rings[k][static_cast<std::size_t>(s)]);
    for (std::uint32_t k = 0; k < 4; ++k)
        for (std::uint32_t s = 0; s < kSides; ++s) {
            const std::uint32_t next = (s + 1) % kSides;
            const std::uint32_t above = (k + 1) % 4;
            mesh.addQuad(
                k * kSides + s, k * kSides + next, above * kSides + next, above * kSides + s);
        }
    for (int spoke = 0; spoke < 6; ++spoke) {
        const double a = kPi * spoke / 3.0;
        addBeam(mesh,
                {0.0, 0.05 * cosine(a), 0.05 * sine(a)},
                {0.0, (radius - 0.06) * cosine(a), (radius - 0.06) * sine(a)},
                0.05);
    }
    addBeam(mesh, {-0.11, 0.0, 0.0}, {0.11, 0.0, 0.0}, 0.17);
    return mesh;
}

} // namespace

Mesh makeRoadSlab() {
    // A cross-section with gutters, swept along z.
    const std::array<glm::dvec2, 8> section{{{-2.4, -0.5},
                                             {2.4, -0.5},
                                             {2.4, 0.06},
                                             {2.0, 0.02},
                                             {1.0, 0.10},
                                             {-1.0, 0.10},
                                             {-2.0, 0.02},
                                             {-2.4, 0.06}}};
    Mesh mesh;
    std::vector<Ring> rings;
    for (const double z : {-1.0, 1.0}) {
        Ring ring;
        for (const glm::dvec2& p : section)
            ring.emplace_back(p.x, p.y, z);
        rings.push_back(std::move(ring));
    }
    addLoft(mesh, rings, Ends::Open);
    for (const std::uint32_t base : {0u, 8u}) { // not convex: capped by hand
        const std::array<std::array<std::uint32_t, 3>, 6> cap{
            {{0, 1, 3}, {1, 2, 3}, {0, 3, 4}, {0, 4, 5}, {0, 5, 6}, {0, 6, 7}}};
        for (const auto& t : cap)
            base == 0 ? mesh.addTriangle(t[0], t[2], t[1])
                      : mesh.addTriangle(t[0] + 8, t[1] + 8, t[2] + 8);
    }
    return mesh;
}

Mesh makeSquare() {
    Mesh mesh;
    addTurned(
        mesh, std::array<glm::dvec2, 4>{{{1.0, -0.9}, {1.0, 0.10}, {0.97, 0.14}, {0.3, 0.16}}}, 24);
    return mesh;
}

Mesh makeKerb() {
    Mesh mesh;
    addBevelledBar(mesh, {0.18, 0.45, 0.97, 0.03, 1, {}});
    Mesh kerb;
    kerb.append(mesh, moved({0.0, -0.10, -0.485}) * rotatedX(kPi / 2.0));
    return kerb;
}

Mesh makePavingStone() {
    Mesh mesh;
    addTurned(mesh, std::array<glm::dvec2, 3>{{{0.30, -0.15}, {0.31, 0.03}, {0.26, 0.06}}}, 7);
    return mesh;
}

Mesh makeTreeTrunk(double height, double radius, int branches, Random& random) {
    Mesh mesh;
    std::vector<PathPoint> path;
    for (int r = 0; r <= 6; ++r) {
        const double t = r / 6.0;
        const double flare = t < 0.1 ? 1.7 : 1.0;
        path.push_back(
            {{0.12 * sine(4.0 * t), height * t - (r == 0 ? 0.6 : 0.0), 0.12 * sine(5.0 * t)},
             radius * flare * (1.0 - 0.65 * t)});
    }
    addTube(mesh, path, 8);
    for (int b = 0; b < branches; ++b) {
        const double a = 2.4 * b + random.in(0.0, 0.5);
        const glm::dvec3 from =
            path[4].position + glm::dvec3(0.0, height * 0.05 * b / branches, 0.0);
        const glm::dvec3 out(cosine(a), 0.9, sine(a));
        const std::array<PathPoint, 3> bough{
            {{from, radius * 0.42},
             {from + out * (height * 0.16), radius * 0.30},
             {from + out * (height * 0.27) + glm::dvec3(0.0, height * 0.05, 0.0), radius * 0.12}}};
        addTube(mesh, bough, 6);
    }
    return mesh;
}

Mesh makeCrown(const CrownShape& shape, Random& random) {
    Mesh mesh;
    for (int l = 0; l < shape.lumps; ++l) {
        // The first lump fills the middle; the others sit around it, a ring above a ring.
        const double a = 2.399963 * l + random.about(0.0, 0.3);
        const double up = l == 0 ? 0.1 : 1.15 * l / shape.lumps - 0.42;
        const double out = l == 0 ? 0.0 : 0.62 * (1.0 - 0.55 * std::max(0.0, up));
        const double size = shape.lump_size * (l == 0 ? 1.3 : random.in(0.82, 1.12));
        const auto seed = static_cast<std::uint32_t>(random.bits());
        Mesh lump = ball(shape.level);
        for (glm::dvec3& p : lump.positions) {
            const double leaves = fractalNoise(p * 2.6, seed, 3);
            p *= 1.0 + 0.28 * leaves;
        }
        mesh.append(lump,
                    moved(glm::dvec3(0.0, shape.height, 0.0) +
                          glm::dvec3(out * cosine(a), up, out * sine(a)) * shape.radii) *
                        scaled(shape.radii * size));
    }
    return mesh;
}

Mesh makeSpruce(Random& random) {
    Mesh mesh;
    constexpr int kTiers = 6;
    constexpr int kSides = 10;
    for (int tier = 0; tier < kTiers; ++tier) {
        const double t = static_cast<double>(tier) / kTiers;
        const double radius = 2.1 * (1.0 - t) + 0.35;
        const double y = 1.2 + 8.2 * t;
        const double turn = random.in(0.0, 1.0);
        std::vector<Ring> rings(4);
        for (int s = 0; s < kSides; ++s) {
            const double a = -2.0 * kPi * (s + turn) / kSides;
            const double tip = s % 2 == 0 ? 1.0 : 0.72;
            const double sag = s % 2 == 0 ? -0.35 : 0.05;
            const glm::dvec3 dir(cosine(a), 0.0, sine(a));
            const double jitter = random.in(0.9, 1.1);
            rings[0].push_back(dir * (radius * 0.25) + glm::dvec3(0.0, y + 0.25, 0.0));
            rings[1].push_back(dir * (radius * tip * jitter) + glm::dvec3(0.0, y + sag, 0.0));
            rings[2].push_back(dir * (radius * 0.5) + glm::dvec3(0.0, y + 0.75, 0.0));
            rings[3].push_back(dir * 0.05 + glm::dvec3(0.0, y + 1.9, 0.0));
        }
        addLoft(mesh, rings);
    }
    return mesh;
}

Mesh makePoplar(Random& random) {
    Mesh mesh;
    for (int l = 0; l < 5; ++l) {
        const auto seed = static_cast<std::uint32_t>(random.bits());
        Mesh lump = ball(2);
        for (glm::dvec3& p : lump.positions)
            p *= 1.0 + 0.22 * fractalNoise(p * 2.4, seed, 3);
        const double width = 1.25 - 0.16 * l;
        mesh.append(lump,
                    moved({random.about(0.0, 0.25), 3.2 + 2.1 * l, random.about(0.0, 0.25)}) *
                        scaled({width, 2.3, width}));
    }
    return mesh;
}

Mesh makeHedge(Random& random) {
    Mesh mesh;
    addBox(mesh, {-1.05, -0.5, -0.36}, {1.05, 1.05, 0.36});
    refineTo(mesh, 140);
    const auto seed = static_cast<std::uint32_t>(random.bits());
    for (glm::dvec3& p : mesh.positions)
        p += glm::dvec3(0.3, 1.0, 1.0) * 0.10 *
             glm::dvec3(noise(p * 2.7, seed), noise(p * 2.9, seed + 1), noise(p * 2.8, seed + 2));
    return mesh;
}

Mesh makeFlowers(Random& random) {
    Mesh mesh;
    for (int f = 0; f < 5; ++f) {
        const double a = 2.4 * f;
        const glm::dvec3 at(0.12 * cosine(a) * std::max(1, f / 2),
                            random.in(0.22, 0.42),
                            0.12 * sine(a) * std::max(1, f / 2));
        const double s = random.in(0.055, 0.085);
        Mesh head;
        addTurned(head, std::array<glm::dvec2, 3>{{{0.10, -5.0}, {0.25, -0.8}, {1.0, 0.4}}}, 5);
        mesh.append(head, moved(at) * scaled({s, s, s}));
    }
    return mesh;
}

Mesh makeTuft(int blades, Random& random) {
    Mesh mesh;
    for (int b = 0; b < blades; ++b) {
        const double a = 2.399963 * b;
        const glm::dvec3 out(cosine(a), 0.0, sine(a));
        const glm::dvec3 side = glm::dvec3(-out.z, 0.0, out.x) * 0.030;
        const double height = random.in(0.30, 0.55);
        const double lean = random.in(0.08, 0.30);
        const glm::dvec3 foot = out * 0.06 - glm::dvec3(0.0, 0.1, 0.0);
        const glm::dvec3 knee = foot + out * (lean * 0.35) + glm::dvec3(0.0, height * 0.65, 0.0);
        const glm::dvec3 tip = foot + out * lean + glm::dvec3(0.0, height, 0.0);
        const std::uint32_t v = mesh.addVertex(foot - side);
        mesh.addVertex(foot + side);
        mesh.addVertex(knee + side * 0.8);
        mesh.addVertex(knee - side * 0.8);
        mesh.addVertex(tip);
        mesh.addQuad(v, v + 1, v + 2, v + 3);
        mesh.addTriangle(v + 3, v + 2, v + 4);
    }
    return mesh;
}

Mesh makeFencePanel() {
    Mesh mesh = boxes({{{{-1.0, 0.30, -0.055}, {1.0, 0.40, -0.012}}},
                       {{{-1.0, 0.78, -0.055}, {1.0, 0.88, -0.012}}}});
    for (int p = 0; p < 8; ++p) {
        const double x = -0.875 + 0.25 * p;
        const Ring outline{{x - 0.055, 0.06, -0.012},
                           {x + 0.055, 0.06, -0.012},
                           {x + 0.055, 0.98, -0.012},
                           {x, 1.10, -0.012},
                           {x - 0.055, 0.98, -0.012}};
        Ring front = outline;
        for (glm::dvec3& q : front)
            q.z = 0.018;
        addLoft(mesh, std::array{outline, front});
    }
    return mesh;
}

Mesh makeFencePost() {
    Mesh mesh;
    addTurned(mesh, std::array<glm::dvec2, 3>{{{0.10, -0.6}, {0.10, 1.14}, {0.02, 1.26}}}, 4);
    Mesh post;
    post.append(mesh, rotatedY(kPi / 4.0));
    return post;
}

Mesh makeStoneWall(Random& random) {
    Mesh mesh;
    for (int row = 0; row < 3; ++row)
        for (int s = 0; s < 4; ++s) {
            const double x = -1.0 + 0.5 * s + (row % 2 == 0 ? 0.0 : 0.12);
            const double top = 0.3 * (row + 1) + random.about(0.0, 0.04);
            const double z = 0.30 - 0.05 * row + random.about(0.0, 0.03);
            addBox(mesh,
                   {x, row == 0 ? -0.6 : 0.3 * row - 0.06, -z},
                   {x + random.in(0.46, 0.53), top, z});
        }
    return mesh;
}

Mesh makeLampPost() {
    Mesh mesh;
    const std::array<glm::dvec2, 8> profile{{{0.17, -0.5},
                                             {0.17, 0.25},
                                             {0.10, 0.45},
                                             {0.06, 0.55},
                                             {0.045, 2.6},
                                             {0.08, 2.65},
                                             {0.04, 2.75},
                                             {0.04, 2.95}}};
    addTurned(mesh, profile, 8);
    addTurned(mesh, std::array<glm::dvec2, 3>{{{0.12, 2.95}, {0.16, 3.02}, {0.15, 3.05}}}, 6);
    addTurned(mesh,
              std::array<glm::dvec2, 4>{{{0.25, 3.48}, {0.22, 3.55}, {0.06, 3.72}, {0.03, 3.86}}},
              6);
    addBox(mesh, {-0.42, 2.55, -0.02}, {0.42, 2.59, 0.02});
    return mesh;
}

Mesh makeLampGlass() {
    Mesh mesh;
    addTurned(mesh, std::array<glm::dvec2, 2>{{{0.13, 3.05}, {0.21, 3.48}}}, 6);
    return mesh;
}

Mesh makeWell() {
    Mesh mesh;
    const std::array<glm::dvec2, 5> profile{
        {{1.05, -0.6}, {1.0, 0.75}, {1.12, 0.80}, {1.12, 0.98}, {0.8, 0.99}}};
    addTurned(mesh, profile, 14);
    return mesh;
}

Mesh makeWellRoof() {
    Mesh mesh = boxes(
        {{{{-1.0, 0.2, -0.09}, {-0.82, 2.4, 0.09}}}, {{{0.82, 0.2, -0.09}, {1.0, 2.4, 0.09}}}});
    addBeam(mesh, {-1.15, 1.7, 0.0}, {1.15, 1.7, 0.0}, 0.16);
    for (const double side : {-1.0, 1.0}) {
        Mesh slope;
        addBox(slope, {-1.3, 0.0, 0.0}, {1.3, 0.09, 1.35});
        mesh.append(slope,
                    side > 0.0 ? moved({0.0, 2.85, 0.0}) * rotatedX(0.65)
                               : moved({0.0, 2.85, 0.0}) * rotatedY(kPi) * rotatedX(0.65));
    }
    return mesh;
}

Mesh makeBench() {
    Mesh mesh;
    for (const double x : {-0.75, 0.75}) {
        addBox(mesh, {x - 0.05, -0.2, -0.22}, {x + 0.05, 0.40, -0.12});
        addBox(mesh, {x - 0.05, -0.2, 0.12}, {x + 0.05, 0.40, 0.22});
        addBox(mesh, {x - 0.05, 0.36, -0.28}, {x + 0.05, 0.42, 0.24});
        addBeam(mesh, {x, 0.35, -0.22}, {x, 0.92, -0.34}, 0.08);
    }
    for (int s = 0; s < 4; ++s)
        addBox(mesh, {-0.95, 0.42, -0.23 + 0.12 * s}, {0.95, 0.46, -0.13 + 0.12 * s});
    for (const double y : {0.60, 0.78})
        addBox(
            mesh, {-0.95, y, -0.30 - 0.06 * y + 0.06}, {0.95, y + 0.11, -0.265 - 0.06 * y + 0.06});
    return mesh;
}

Mesh makeCart() {
    Mesh mesh = boxes({{{{-0.75, 0.72, -1.3}, {0.75, 0.80, 1.3}}},
                       {{{-0.80, 0.80, -1.3}, {-0.74, 1.25, 1.3}}},
                       {{{0.74, 0.80, -1.3}, {0.80, 1.25, 1.3}}},
                       {{{-0.74, 0.80, -1.32}, {0.74, 1.20, -1.26}}}});
    for (const double side : {-1.0, 1.0}) {
        mesh.append(wheel(0.62), moved({side * 0.95, 0.62, -0.2}));
        addBeam(mesh, {side * 0.5, 0.70, 1.2}, {side * 0.42, 0.12, 3.2}, 0.09);
    }
    addBeam(mesh, {-0.95, 0.62, -0.2}, {0.95, 0.62, -0.2}, 0.09);
    return mesh;
}

Mesh makeRock(Random& random, double flatness) {
    Mesh mesh = ball(1);
    const auto seed = static_cast<std::uint32_t>(random.bits());
    for (glm::dvec3& p : mesh.positions) {
        p *= 1.0 + 0.35 * fractalNoise(p * 1.3, seed, 2);
        p = p * glm::dvec3(1.0, flatness, 0.8) + glm::dvec3(0.0, 0.25 * flatness, 0.0);
    }
    return mesh;
}

} // namespace lodestone::generate
