#include "scene/generate/village_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lodestone::generate {

namespace {

using Line = std::vector<glm::dvec2>;

// Catmull-Rom.
glm::dvec2 curve(const std::array<glm::dvec2, 4>& p, double t) {
    return 0.5 * (2.0 * p[1] + (p[2] - p[0]) * t +
                  (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3]) * (t * t) +
                  (3.0 * p[1] - p[0] - 3.0 * p[2] + p[3]) * (t * t * t));
}

Line smoothLine(const Line& knots) {
    Line line;
    for (std::size_t k = 0; k + 1 < knots.size(); ++k)
        for (int i = 0; i < 100; ++i)
            line.push_back(curve({knots[k == 0 ? 0 : k - 1],
                                  knots[k],
                                  knots[k + 1],
                                  knots[std::min(k + 2, knots.size() - 1)]},
                                 i / 100.0));
    line.push_back(knots.back());
    return line;
}

Road roadAlong(const Line& knots) {
    const Line line = smoothLine(knots);
    Road road;
    double wait = 0.0;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const glm::dvec2 step = line[i + 1] - line[i];
        const double length = glm::length(step);
        for (; wait < length; wait += 1.0)
            road.points.push_back({line[i] + step * (wait / length), step / length});
        wait -= length;
    }
    return road;
}

} // namespace

double groundHeight(double x, double z) {
    const double far = std::sqrt(x * x + z * z);
    const double rolling =
        5.0 * noise({x * 0.011, 0.5, z * 0.011}, 21) + 1.0 * noise({x * 0.03, 1.5, z * 0.03}, 22);
    const double hills = 15.0 * (0.5 + 0.5 * noise({x * 0.012 + 4.0, 2.5, z * 0.012}, 23));
    return rolling * (0.45 + 0.55 * smoothStep(20.0, 120.0, far)) +
           hills * smoothStep(105.0, 215.0, far);
}

glm::dvec3 onGround(double x, double z) {
    return {x, groundHeight(x, z), z};
}

glm::dvec3 groundNormal(double x, double z) {
    constexpr double kStep = 0.5;
    return glm::normalize(glm::dvec3(groundHeight(x - kStep, z) - groundHeight(x + kStep, z),
                                     2.0 * kStep,
                                     groundHeight(x, z - kStep) - groundHeight(x, z + kStep)));
}

std::vector<Road> planRoads() {
    std::vector<Road> roads;
    for (const Line& knots : std::vector<Line>{
             {{-188, -28}, {-115, -8}, {-55, 6}, {0, 0}, {58, -9}, {118, 8}, {188, -14}},
             {{0, 0}, {9, 46}, {-6, 98}, {14, 142}, {4, 188}},
             {{0, 0}, {-11, -46}, {8, -98}, {-8, -140}, {6, -188}},
             {{-55, 6}, {-64, 48}, {-98, 82}, {-104, 128}},
             {{58, -9}, {66, -52}, {104, -84}, {112, -130}},
             {{9, 46}, {56, 54}, {98, 74}, {136, 112}},
             {{-11, -46}, {-60, -54}, {-104, -80}, {-136, -120}}})
        roads.push_back(roadAlong(knots));
    roads[0].main = true;
    return roads;
}

double roadDistance(const std::vector<Road>& roads, const glm::dvec2& p) {
    double nearest2 = std::numeric_limits<double>::max();
    for (const Road& road : roads)
        for (const RoadPoint& point : road.points)
            nearest2 = std::min(nearest2, glm::dot(point.at - p, point.at - p));
    return std::sqrt(nearest2);
}

int Sites::cellOf(double coordinate) {
    const double cell = (coordinate + kLandHalf) / (2.0 * kLandHalf) * kCells;
    return std::clamp(static_cast<int>(std::floor(cell)), 0, kCells - 1);
}

std::size_t Sites::cellIndex(int x, int z) {
    return static_cast<std::size_t>(z) * kCells + static_cast<std::size_t>(x);
}

bool Sites::isFree(const glm::dvec2& p, double radius) const {
    for (int z = cellOf(p.y - radius); z <= cellOf(p.y + radius); ++z)
        for (int x = cellOf(p.x - radius); x <= cellOf(p.x + radius); ++x)
            for (const Disc& disc : cells_[cellIndex(x, z)])
                if (glm::length(disc.center - p) < disc.radius + radius)
                    return false;
    return true;
}

void Sites::take(const glm::dvec2& p, double radius) {
    for (int z = cellOf(p.y - radius); z <= cellOf(p.y + radius); ++z)
        for (int x = cellOf(p.x - radius); x <= cellOf(p.x + radius); ++x)
            cells_[cellIndex(x, z)].push_back({p, radius});
}

} // namespace lodestone::generate
