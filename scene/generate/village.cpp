// A village on gentle hills, planned along its roads.
#include "scene/generate/sample.h"
#include "scene/generate/village_houses.h"
#include "scene/generate/village_plan.h"
#include "scene/generate/village_props.h"

#include <algorithm>
#include <cmath>

namespace lodestone::generate {

namespace {

constexpr std::size_t kInstances = 13523;
constexpr std::size_t kTriangles = 1254696;
constexpr int kHouseTypes = 20;
constexpr double kSquareRadius = 15.0;
constexpr double kHardEdge = 0.5;
constexpr double kLeafy = 1.2;

// Turns z towards (x, z) = heading.
glm::dquat facing(const glm::dvec2& heading) {
    return upright(glm::dvec3(0, 1, 0), glm::dvec3(heading.x, 0.0, heading.y));
}

glm::dvec2 leftOf(const glm::dvec2& heading) {
    return {heading.y, -heading.x};
}

Trs within(const Trs& outer, const Fitting& fitting) {
    return {outer.translation + outer.rotation * fitting.position,
            outer.rotation * yaw(fitting.angle),
            glm::dvec3(1.0)};
}

class VillageBuilder {
public:
    explicit VillageBuilder(std::uint64_t seed)
        : random_(seed), sample_("village"), roads_(planRoads()) {}

    ScenePtr build() {
        makeParts();
        placeRoads();
        placeChurch();
        placeHouses();
        placeStreetFurniture();
        placeFieldWalls();
        placeTrees();
        placeUndergrowth();
        placeGround();
        return sample_.finish();
    }

private:
    struct House {
        HouseType type;
        std::uint32_t walls, roof;
    };

    struct Tree {
        std::uint32_t trunk, crown;
    };

    struct Lot {
        glm::dvec2 at;
        glm::dvec2 front; // unit, towards the road
        double to_road;   // from the house's middle to the middle of the road
    };

    void makeParts();
    void makeHouses();
    void makeTrees();
    void makeProps();
    void placeRoads();
    void placeChurch();
    void placeHouses();
    void furnish(const Lot& lot, const House& house);
    void fenceLot(const Lot& lot);
    void plantGarden(const Lot& lot);
    void placeStreetFurniture();
    void placeFieldWalls();
    void placeTrees();
    void placeTree(const Tree& tree, const glm::dvec2& at, double scale);
    void placeUndergrowth();
    void placeGround();

    bool clearOfRoads(const glm::dvec2& p, double margin) const {
        return roadDistance(roads_, p) > kRoadHalfWidth + margin &&
               glm::length(p) > kSquareRadius + margin;
    }

    // Follows the ground: x along `along`, as upright as the slope lets it.
    void
    along(std::uint32_t part, const glm::dvec2& at, const glm::dvec2& along, std::uint32_t group);

    Random random_;
    Sample sample_;
    std::vector<Road> roads_;
    Sites sites_;
    std::vector<House> houses_;
    std::vector<Tree> trees_;
    std::vector<std::uint32_t> undergrowth_;
    std::uint32_t window_ = 0, pane_ = 0, shutter_ = 0, chimney_ = 0, wide_chimney_ = 0;
    std::array<std::uint32_t, 2> doors_{};
    std::uint32_t slab_ = 0, square_ = 0, kerb_ = 0, stone_ = 0;
    std::uint32_t panel_ = 0, post_ = 0, wall_ = 0, hedge_ = 0, flowers_ = 0;
    std::uint32_t lamp_ = 0, glass_ = 0, well_ = 0, well_roof_ = 0, bench_ = 0, cart_ = 0;
    std::uint32_t rock_ = 0;
    std::array<std::uint32_t, 2> bushes_{};
    std::uint32_t house_group_ = 0, garden_group_ = 0;
};

void VillageBuilder::makeParts() {
    makeHouses();
    makeTrees();
    makeProps();
}

void VillageBuilder::makeHouses() {
    for (int i = 0; i < kHouseTypes; ++i) {
        House house{makeHouseType(i, random_), 0, 0};
        const std::string name = "house " + std::to_string(i + 1);
        house.walls = sample_.add(
            name + " walls", house.type.walls, kHardEdge, {house.type.wall_color, 0.95});
        house.roof =
            sample_.add(name + " roof", house.type.roof, kHardEdge, {house.type.roof_color, 0.9});
        houses_.push_back(std::move(house));
    }
    window_ = sample_.add("window frame", makeWindowFrame(), kHardEdge, {0xF1EEE6, 0.7});
    pane_ = sample_.add("window pane", makeWindowPane(), kHardEdge, {0x3C4A55, 0.15});
    shutter_ = sample_.add("shutter", makeShutter(), kHardEdge, {0x4F6B57, 0.8});
    doors_[0] = sample_.add("panelled door", makeDoor(true), kHardEdge, {0x6B3F2A, 0.7});
    doors_[1] = sample_.add("plank door", makeDoor(false), kHardEdge, {0x35556A, 0.7});
    chimney_ = sample_.add("chimney", makeChimney(false), kHardEdge, {0x8F5A45, 0.95});
    wide_chimney_ = sample_.add("wide chimney", makeChimney(true), kHardEdge, {0x9A6A50, 0.95});
}

void VillageBuilder::makeTrees() {
    const auto crown = [&](const std::string& name, const CrownShape& shape, std::uint32_t color) {
        return sample_.add(name, makeCrown(shape, random_), kLeafy, {color, 0.95});
    };
    const auto trunk = [&](const std::string& name,
                           double height,
                           double radius,
                           int branches,
                           std::uint32_t color) {
        return sample_.add(
            name, makeTreeTrunk(height, radius, branches, random_), kLeafy, {color, 0.95});
    };
    const std::uint32_t oak = trunk("oak trunk", 6.0, 0.36, 4, 0x5E4A3A);
    const std::uint32_t birch = trunk("birch trunk", 8.0, 0.17, 3, 0xCFC9BC);
    const std::uint32_t fir = trunk("fir trunk", 7.0, 0.24, 0, 0x5A4334);
    trees_.push_back({oak, crown("oak crown", {6.2, {2.9, 2.3, 2.9}, 5, 0.66, 2}, 0x5F7F35)});
    trees_.push_back({birch, crown("birch crown", {6.6, {1.6, 2.6, 1.6}, 5, 0.64, 2}, 0x8DA04A)});
    trees_.push_back({fir, sample_.add("spruce", makeSpruce(random_), 0.7, {0x2F5438, 0.95})});
    trees_.push_back({fir, sample_.add("poplar", makePoplar(random_), kLeafy, {0x6C8C3E, 0.95})});
    trees_.push_back({oak, crown("apple crown", {5.4, {2.3, 1.7, 2.3}, 5, 0.70, 1}, 0x7F9A45)});
}

void VillageBuilder::makeProps() {
    const auto hard = [&](const std::string& name, const Mesh& mesh, std::uint32_t color) {
        return sample_.add(name, mesh, kHardEdge, {color, 0.95});
    };
    slab_ = hard("road segment", makeRoadSlab(), 0xA79A86);
    square_ = hard("village square", makeSquare(), 0xB3A690);
    kerb_ = hard("kerb stone", makeKerb(), 0xBDB5A6);
    stone_ = hard("stepping stone", makePavingStone(), 0xA9A196);
    panel_ = hard("fence panel", makeFencePanel(), 0xE8E4DA);
    post_ = hard("fence post", makeFencePost(), 0xDDD8CC);
    wall_ = hard("stone wall", makeStoneWall(random_), 0x9B9488);
    hedge_ = sample_.add("hedge", makeHedge(random_), kLeafy, {0x4C6B33, 0.95});
    flowers_ = hard("flowers", makeFlowers(random_), 0xC4527A);
    lamp_ = hard("lamp post", makeLampPost(), 0x2E3336);
    glass_ = sample_.add("lamp glass", makeLampGlass(), kHardEdge, {0xF6E3A8, 0.3});
    well_ = hard("well", makeWell(), 0xA39C90);
    well_roof_ = hard("well roof", makeWellRoof(), 0x74533C);
    bench_ = hard("bench", makeBench(), 0x8A6240);
    cart_ = hard("hay cart", makeCart(), 0x8B6B48);
    rock_ = hard("boulder", makeRock(random_, 0.7), 0x8C8880);
    for (std::size_t b = 0; b < 2; ++b) {
        const CrownShape shape{0.5, {0.8, 0.6, 0.8}, b == 0 ? 3 : 2, 0.75, 1};
        bushes_[b] = sample_.add(b == 0 ? "bush" : "lilac bush",
                                 makeCrown(shape, random_),
                                 kLeafy,
                                 {b == 0 ? 0x5B7B38u : 0x8D78A5u, 0.95});
    }
    undergrowth_ = {sample_.add("grass tuft", makeTuft(6, random_), kPi, {0x78923F, 1.0, true}),
                    sample_.add("tall grass", makeTuft(8, random_), kPi, {0xA39A4E, 1.0, true})};
}

void VillageBuilder::along(std::uint32_t part,
                           const glm::dvec2& at,
                           const glm::dvec2& along,
                           std::uint32_t group) {
    const glm::dvec3 from = onGround(at.x - along.x, at.y - along.y);
    const glm::dvec3 to = onGround(at.x + along.x, at.y + along.y);
    const glm::dvec3 x = glm::normalize(to - from);
    const glm::dvec3 z = glm::normalize(glm::cross(x, glm::dvec3(0, 1, 0)));
    const glm::dquat rotation = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
    sample_.place(part, {onGround(at.x, at.y), rotation, glm::dvec3(1.0)}, group);
}

void VillageBuilder::placeRoads() {
    const std::uint32_t group = sample_.addGroup("roads");
    for (const Road& road : roads_)
        for (std::size_t i = 1; i < road.points.size(); i += 2) {
            const RoadPoint& p = road.points[i];
            if (&road != &roads_[0] && glm::length(p.at) < kSquareRadius - 2.0)
                continue; // the square is paved
            const glm::dvec3 forward(p.heading.x, 0.0, p.heading.y);
            const glm::dquat rotation = upright(groundNormal(p.at.x, p.at.y), forward);
            // A little longer than the step, so that bends show no gap.
            sample_.place(slab_, {onGround(p.at.x, p.at.y), rotation, {1.0, 1.0, 1.12}}, group);
        }
    sample_.place(square_,
                  {onGround(0.0, 0.0),
                   upright(groundNormal(0.0, 0.0), {0, 0, 1}),
                   {kSquareRadius, 1.0, kSquareRadius}},
                  group);
    for (std::size_t i = 60; i + 60 < roads_[0].points.size(); ++i)
        for (const double side : {-1.0, 1.0}) {
            const RoadPoint& p = roads_[0].points[i];
            const glm::dvec2 at = p.at + leftOf(p.heading) * (side * (kRoadHalfWidth + 0.08));
            double others = 1e9;
            for (std::size_t r = 1; r < roads_.size(); ++r)
                others = std::min(others, roadDistance({roads_[r]}, at));
            if (glm::length(at) > kSquareRadius && others > kRoadHalfWidth + 0.5)
                sample_.place(kerb_,
                              {onGround(at.x, at.y),
                               upright(groundNormal(at.x, at.y), {p.heading.x, 0.0, p.heading.y}),
                               glm::dvec3(1.0)},
                              group);
        }
}

void VillageBuilder::placeChurch() {
    const Church church = makeChurch();
    const std::uint32_t walls =
        sample_.add("church walls", church.walls, kHardEdge, {0xC9C0AE, 0.95});
    const std::uint32_t roof = sample_.add("church roof", church.roof, kHardEdge, {0x56606A, 0.85});
    const std::uint32_t windows =
        sample_.add("church windows", church.windows, kHardEdge, {0x33414E, 0.2});
    const glm::dvec2 at(31.0, 24.0);
    const glm::dvec2 front = glm::normalize(glm::dvec2(-1.0, -0.75));
    const Trs trs{onGround(at.x, at.y) + glm::dvec3(0.0, 0.3, 0.0), facing(front), glm::dvec3(1.0)};
    const std::uint32_t group = sample_.addGroup("church");
    for (const std::uint32_t part : {walls, roof, windows})
        sample_.place(part, trs, group);
    sites_.take(at, 12.0);
    sites_.take(at + front * 10.0, 6.0);
    sites_.take(at - front * 6.0, 8.0);
}

void VillageBuilder::placeHouses() {
    house_group_ = sample_.addGroup("houses");
    garden_group_ = sample_.addGroup("gardens");
    constexpr double kSetBack = kRoadHalfWidth + 3.4 + kHouseRadius;
    std::vector<Lot> lots;
    for (const Road& road : roads_)
        for (std::size_t i = 8; i + 30 < road.points.size(); ++i)
            for (const double side : {-1.0, 1.0}) {
                const RoadPoint& p = road.points[i];
                const glm::dvec2 out = leftOf(p.heading) * side;
                const glm::dvec2 at = p.at + out * kSetBack;
                const bool far = glm::length(at) > (road.main ? 150.0 : 118.0);
                if (far || !clearOfRoads(at, kHouseRadius + 2.4) ||
                    !sites_.isFree(at, kHouseRadius))
                    continue;
                sites_.take(at, kHouseRadius + 0.25);
                lots.push_back({at, -out, kSetBack});
            }
    for (std::size_t l = 0; l < lots.size(); ++l) {
        // Neighbours differ; the seed decides which type comes where.
        const std::size_t type = (l * 7 + random_.below(5) * 4) % houses_.size();
        furnish(lots[l], houses_[type]);
        fenceLot(lots[l]);
        plantGarden(lots[l]);
    }
}

void VillageBuilder::furnish(const Lot& lot, const House& house) {
    const glm::dvec3 ground = onGround(lot.at.x, lot.at.y);
    const Trs trs{ground + glm::dvec3(0.0, 0.25, 0.0), facing(lot.front), glm::dvec3(1.0)};
    sample_.place(house.walls, trs, house_group_);
    sample_.place(house.roof, trs, house_group_);
    for (const Fitting& f : house.type.windows) {
        sample_.place(window_, within(trs, f), house_group_);
        sample_.place(pane_, within(trs, f), house_group_);
        for (const double side : {-1.0, 1.0})
            if (house.type.shutters && f.angle == 0.0) {
                Fitting shutter = f;
                shutter.position.x += side * (kWindowWidth / 2.0 + 0.26);
                sample_.place(shutter_, within(trs, shutter), house_group_);
            }
    }
    for (const Fitting& f : house.type.doors)
        sample_.place(doors_[random_.below(2)], within(trs, f), house_group_);
    for (const Fitting& f : house.type.chimneys)
        sample_.place(
            random_.below(3) == 0 ? wide_chimney_ : chimney_, within(trs, f), house_group_);
}

void VillageBuilder::fenceLot(const Lot& lot) {
    const glm::dvec2 side = leftOf(lot.front);
    const double out = lot.to_road - kRoadHalfWidth - 1.3;
    const bool hedged = random_.below(3) == 0;
    const glm::dvec2 gate = lot.at + lot.front * out;
    for (int p = -3; p <= 3; ++p) {
        const glm::dvec2 at = gate + side * (2.0 * p);
        if (p == 0 || !clearOfRoads(at, 0.8))
            continue; // the way to the door
        along(hedged ? hedge_ : panel_, at, side, garden_group_);
        if (!hedged)
            for (const double end : {-1.0, 1.0})
                if (end > 0.0 || p == -3 || p == 1)
                    along(post_, at + side * end, side, garden_group_);
    }
    for (int s = 0; s < 6; ++s) {
        const glm::dvec2 at = lot.at + lot.front * (out + 0.6 - 0.85 * s);
        along(stone_, at + side * random_.about(0.0, 0.1), side, garden_group_);
    }
}

void VillageBuilder::plantGarden(const Lot& lot) {
    const glm::dvec2 side = leftOf(lot.front);
    for (const double s : {-1.0, 1.0})
        for (int f = 0; f < 3; ++f) {
            const glm::dvec2 at =
                lot.at + lot.front * (4.6 + random_.about(0.0, 0.2)) + side * (s * (1.3 + 0.9 * f));
            const std::uint32_t part = f == 2 ? bushes_[random_.below(2)] : flowers_;
            sample_.place(part,
                          {onGround(at.x, at.y),
                           yaw(random_.in(0.0, 6.28)),
                           glm::dvec3(random_.in(0.8, 1.2))},
                          garden_group_);
        }
    const glm::dvec2 back = lot.at - lot.front * 9.5 + side * random_.about(0.0, 3.0);
    if (clearOfRoads(back, 4.0) && sites_.isFree(back, 2.2)) {
        sites_.take(back, 2.2);
        placeTree(trees_[4], back, random_.in(0.5, 0.75));
    }
}

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

} // namespace

ScenePtr makeVillage(std::uint64_t seed) {
    return VillageBuilder(seed).build();
}

} // namespace lodestone::generate
