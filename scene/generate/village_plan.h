#pragma once
// The lie of the land and where things may stand. Metres, y up.
#include "scene/generate/numbers.h"

#include <string>
#include <vector>

namespace lodestone::generate {

constexpr double kLandHalf = 190.0; // the land is a square around the origin
constexpr double kRoadHalfWidth = 2.4;

double groundHeight(double x, double z);
glm::dvec3 onGround(double x, double z);
glm::dvec3 groundNormal(double x, double z);

// A place along a road.
struct RoadPoint {
    glm::dvec2 at{0.0};      // (x, z)
    glm::dvec2 heading{0.0}; // unit
};

struct Road {
    std::vector<RoadPoint> points; // one metre apart
    bool main = false;
};

std::vector<Road> planRoads();
// From the middle line of the nearest road.
double roadDistance(const std::vector<Road>& roads, const glm::dvec2& p);

// Discs that are taken.
class Sites {
public:
    bool isFree(const glm::dvec2& p, double radius) const;
    void take(const glm::dvec2& p, double radius);

private:
    struct Disc {
        glm::dvec2 center;
        double radius;
    };

    static constexpr int kCells = 40;
    static int cellOf(double coordinate);
    static std::size_t cellIndex(int x, int z);
    std::vector<std::vector<Disc>> cells_{std::size_t{kCells} *
                                          kCells}; // a disc is in every cell it touches
};

} // namespace lodestone::generate
