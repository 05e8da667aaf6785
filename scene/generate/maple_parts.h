#pragma once
// The pieces a maple tree is put together from, each in its own frame with its root at the origin.
#include "scene/generate/mesh_maker.h"

namespace lodestone::generate {

// Something that grows along +y from the origin to (0, 1, 0), with its middle line kept so that
// others can grow out of it.
struct Limb {
    Mesh mesh;
    std::vector<PathPoint> path;

    glm::dvec3 at(double t) const; // t in 0..1, linear between the path's points
    double radiusAt(double t) const;
};

struct LimbShape {
    double radius = 0.04; // at the root, of a limb of length 1
    double tip_radius = 0.008;
    double bow = 0.1; // how far the middle hangs towards -z
    double wiggle = 0.02;
    double relief = 0.1; // of the bark, relative to the radius
    int sides = 10;
    int rings = 24;
};

Limb makeLimb(const LimbShape& shape, Random& random);

// A twig with paired side shoots. Sockets are where leaves grow: position and direction.
struct Socket {
    glm::dvec3 position;
    glm::dvec3 direction;
};

struct Twig {
    Mesh mesh;
    std::vector<Socket> sockets; // opposite pairs from the root on, the tip last
};

Twig makeTwig(int shoot_pairs, Random& random);

// Leader and roots: not scaled, in metres.
Limb makeTrunkLine(double height, Random& random);
// Skins it with exactly triangle_count triangles (even, at least 8,000).
void skinTrunk(Limb& trunk, std::size_t triangle_count, std::uint32_t seed);

// A leaf blade of about 1 by 1 on a stalk along +y, upper side towards +z. Open, single-sided.
struct LeafShape {
    double lobe_depth = 1.0; // 0: a rounded blade, 1: deeply cut
    double cup = 0.15;       // edges bent up (or down if negative)
    double droop = 0.3;      // tip bent down
    double fold = 0.05;      // halves folded up along the midrib
    double twist = 0.1;
    bool small_teeth = true;
};

Mesh makeLeaf(const LeafShape& shape, Random& random);

// A pair of winged seeds, hanging from the origin towards -y.
Mesh makeWingedSeeds();

} // namespace lodestone::generate
