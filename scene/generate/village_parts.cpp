#include "scene/generate/village_builder.h"
#include "scene/generate/village_props.h"

namespace lodestone::generate {

namespace {

constexpr int kHouseTypes = 20;
constexpr double kHardEdge = 0.5;
constexpr double kLeafy = 1.2;

} // namespace

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

} // namespace lodestone::generate
