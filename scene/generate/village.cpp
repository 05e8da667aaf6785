// A village on gentle hills, planned along its roads.
#include "scene/generate/village_builder.h"

#include <algorithm>
#include <cmath>

namespace lodestone::generate {

namespace {

constexpr double kHardEdge = 0.5;

Trs within(const Trs& outer, const Fitting& fitting) {
    return {outer.translation + outer.rotation * fitting.position,
            outer.rotation * yaw(fitting.angle),
            glm::dvec3(1.0)};
}

} // namespace

glm::dquat facing(const glm::dvec2& heading) {
    return upright(glm::dvec3(0, 1, 0), glm::dvec3(heading.x, 0.0, heading.y));
}

glm::dvec2 leftOf(const glm::dvec2& heading) {
    return {heading.y, -heading.x};
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
        const std::size_t type = (l * 7 + std::size_t{random_.below(5)} * 4) % houses_.size();
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

ScenePtr makeVillage(std::uint64_t seed) {
    return VillageBuilder(seed).build();
}

} // namespace lodestone::generate
