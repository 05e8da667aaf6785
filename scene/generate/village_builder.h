#pragma once
// Puts the village together: parts, then roads, houses with gardens, and the land around.
#include "scene/generate/sample.h"
#include "scene/generate/village_houses.h"
#include "scene/generate/village_plan.h"

namespace lodestone::generate {

constexpr double kSquareRadius = 15.0;

// Turns z towards (x, z) = heading.
glm::dquat facing(const glm::dvec2& heading);
glm::dvec2 leftOf(const glm::dvec2& heading);

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

} // namespace lodestone::generate
