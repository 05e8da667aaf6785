#pragma once
// Everything in the village that is not a house. Metres; standing on y = 0.
#include "scene/generate/mesh_maker.h"

namespace lodestone::generate {

Mesh makeRoadSlab(); // along z, from -1 to 1, slightly raised in the middle
Mesh makeSquare();   // round paving, radius 1
Mesh makeKerb();     // along z, one metre
Mesh makePavingStone();

// Trunk of a tree of height 10 or so, forked where branches > 0.
Mesh makeTreeTrunk(double height, double radius, int branches, Random& random);

// Leaf mass: lumps in a dome around (0, height, 0).
struct CrownShape {
    double height = 6.0;
    glm::dvec3 radii{2.5, 2.0, 2.5};
    int lumps = 7;
    double lump_size = 0.62; // relative to the radii
    int level = 2;           // of the balls
};

Mesh makeCrown(const CrownShape& shape, Random& random);
Mesh makeSpruce(Random& random); // green part only
Mesh makePoplar(Random& random);

Mesh makeHedge(Random& random); // along x, two metres
Mesh makeFlowers(Random& random);
Mesh makeTuft(int blades, Random& random); // open, two-sided
Mesh makeFencePanel();                     // along x, two metres
Mesh makeFencePost();
Mesh makeStoneWall(Random& random); // along x, two metres
Mesh makeLampPost();
Mesh makeLampGlass();
Mesh makeWell();
Mesh makeWellRoof();
Mesh makeBench();
Mesh makeCart();
Mesh makeRock(Random& random, double flatness);

} // namespace lodestone::generate
